// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "python/core/arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace bullet_fem::python
{
namespace
{

std::string reprOf(py::handle object)
{
    std::string text = py::repr(object);
    if (text.size() > 60) text = text.substr(0, 60) + "...";
    return text;
}

std::string nameOf(const py::dtype& type)
{
    return py::str(py::handle(type));
}

std::string shapeOf(const py::array& array)
{
    return textOf(Dims(array.shape(), array.shape() + array.ndim()));
}

/// The object as an array whose type is of these kinds ("f" floating point, "i" and "u" integers).
py::array arrayIn(py::handle object, const char* name, const std::string& kinds, const char* expected)
{
    py::array array;
    if (py::isinstance<py::array>(object))
        array = py::reinterpret_borrow<py::array>(object);
    else
        array = py::array::ensure(object);  // lists and other sequences
    if (!array || (array.size() == 0 && !py::isinstance<py::array>(object)))
    {
        if (array && array.size() == 0) return py::array(py::dtype::of<int>(), Dims{0});
        throw py::type_error(std::string(name) + " is " + reprOf(object) + ": it must be " + expected);
    }
    const py::dtype type = array.dtype();
    if (kinds.find(type.kind()) == std::string::npos)
        throw py::type_error(std::string(name) + " has dtype " + nameOf(type) + ": it must be " + expected);
    if (!type.attr("isnative").cast<bool>())
        throw py::type_error(std::string(name) + " has dtype " + nameOf(type) +
                             ": its byte order is not this machine's; use .astype(float) or .astype(int)");
    return array;
}

void checkShape(const py::array& array, const char* name, const Dims& shape)
{
    bool fits = array.ndim() == py::ssize_t(shape.size());
    for (std::size_t i = 0; fits && i < shape.size(); ++i)
        fits = shape[i] == -1 || shape[i] == array.shape(py::ssize_t(i));
    if (!fits)
        throw py::value_error(std::string(name) + " has shape " + shapeOf(array) + ": it must be " + textOf(shape));
}

std::vector<int> integersOf(py::handle object, const char* name, int columns, long long low, long long high)
{
    const py::array array = arrayIn(object, name, "iu", "an array of integers");
    const bool isEmpty = array.size() == 0 && array.ndim() == 1;
    if (!isEmpty) checkShape(array, name, columns == 1 ? Dims{-1} : Dims{-1, columns});
    if (array.dtype().kind() == 'u' && array.itemsize() == 8)  // beyond a long long
        throw py::type_error(std::string(name) +
                             " has dtype uint64: it must be an array of integers; use .astype(int)");
    const auto values = py::array_t<long long, py::array::c_style | py::array::forcecast>::ensure(array);
    if (!values) throw py::error_already_set();
    std::vector<int> result(std::size_t(values.size()));
    const long long* at = values.data();
    for (std::size_t i = 0; i < result.size(); ++i)
    {
        if (at[i] < low || at[i] > high)
        {
            std::ostringstream text;
            text << name << " has " << at[i] << " at " << i << ": it must be in [" << low << ", " << high << "]";
            throw py::index_error(text.str());
        }
        result[i] = int(at[i]);
    }
    return result;
}

void checkRange(const Doubles& array, const char* name, double largest)
{
    const double* values = array.data();
    for (py::ssize_t i = 0; i < array.size(); ++i)
        if (!(std::abs(values[i]) <= largest))
        {
            std::ostringstream text;
            text << name << " has " << values[i] << " at " << i << ": it must be finite";
            if (std::isfinite(largest)) text << ", in [-" << largest << ", " << largest << "]";
            throw py::value_error(text.str());
        }
}

Doubles threeOf(py::handle object, const char* name, double largest)
{
    Doubles array = doublesOf(object, name, {3});
    checkRange(array, name, largest);
    return array;
}

}  // namespace

std::string textOf(const Dims& shape)
{
    std::string text = "(";
    for (std::size_t i = 0; i < shape.size(); ++i)
        text += (i == 0 ? "" : ", ") + (shape[i] < 0 ? std::string("n") : std::to_string(shape[i]));
    return text + (shape.size() == 1 ? ",)" : ")");
}

Doubles doublesOf(py::handle object, const char* name, const Dims& shape)
{
    const py::array array = arrayIn(object, name, "fiu", "an array of real numbers");
    if (array.size() != 0 || array.ndim() != 1 || shape[0] != -1) checkShape(array, name, shape);
    auto values = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
    if (!values) throw py::error_already_set();
    Doubles result = std::move(values);
    checkRange(result, name, std::numeric_limits<double>::max());
    return result;
}

std::vector<int> indicesOf(py::handle object, const char* name, int limit)
{
    return integersOf(object, name, 1, 0, limit - 1);
}

std::vector<int> indexRowsOf(py::handle object, const char* name, int columns, int limit)
{
    return integersOf(object, name, columns, 0, limit - 1);
}

std::vector<int> labelsOf(py::handle object, const char* name)
{
    return integersOf(object, name, 1, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}

double numberOf(py::handle object, const char* name, double low, double high)
{
    bool isNumber = PyFloat_Check(object.ptr()) || PyLong_Check(object.ptr());
    if (!isNumber && !PySequence_Check(object.ptr()) && !py::isinstance<py::array>(object))
    {
        const py::array scalar = py::array::ensure(object);  // NumPy's scalars
        isNumber = scalar && scalar.ndim() == 0 && std::string("fiu").find(scalar.dtype().kind()) != std::string::npos;
    }
    if (!isNumber) throw py::type_error(std::string(name) + " is " + reprOf(object) + ": it must be a real number");
    const double value = PyFloat_AsDouble(object.ptr());
    if (value == -1 && PyErr_Occurred()) throw py::error_already_set();
    if (value >= low && value <= high) return value;
    std::ostringstream text;
    text << name << " is " << value << ": it must be in [" << low << ", " << high << "]";
    throw py::value_error(text.str());
}

btVector3 vectorOf(py::handle object, const char* name, double largest)
{
    const Doubles array = threeOf(object, name, largest);
    return btVector3(array.at(0), array.at(1), array.at(2));
}

btVector3 directionOf(py::handle object, const char* name)
{
    const btVector3 direction = vectorOf(object, name, 1e12);
    if (!(direction.length2() > 0)) throw py::value_error(std::string(name) + " is 0: it must be a direction");
    return direction.normalized();
}

btQuaternion quaternionOf(py::handle object, const char* name)
{
    const Doubles array = doublesOf(object, name, {4});
    checkRange(array, name, 1e6);
    const btQuaternion quaternion(array.at(0), array.at(1), array.at(2), array.at(3));
    if (!(quaternion.length2() > 1e-12))
        throw py::value_error(std::string(name) + " is 0: it must be a quaternion (x, y, z, w)");
    return quaternion.normalized();
}

btTransform transformOf(py::handle position, py::handle orientation)
{
    return btTransform(quaternionOf(orientation, "orientation"), vectorOf(position, "position"));
}

std::vector<Vec3> vectorsOf(py::handle object, const char* name, py::ssize_t rows, double largest)
{
    const Doubles array = doublesOf(object, name, {rows, 3});
    checkRange(array, name, largest);
    std::vector<Vec3> vectors(std::size_t(array.ndim() == 2 ? array.shape(0) : 0));
    const double* at = array.data();
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = {at[3 * i], at[3 * i + 1], at[3 * i + 2]};
    return vectors;
}

Doubles arrayOf(const btVector3& vector)
{
    Doubles array(3);
    std::copy_n(&vector[0], 3, array.mutable_data());
    return array;
}

Doubles arrayOf(const btQuaternion& quaternion)
{
    Doubles array(4);
    for (int i = 0; i < 4; ++i) array.mutable_at(i) = quaternion[i];
    return array;
}

Doubles arrayOf(const std::vector<Vec3>& vectors)
{
    Doubles array(Dims{py::ssize_t(vectors.size()), 3});
    double* at = array.mutable_data();
    for (const Vec3& vector : vectors)
        for (int i = 0; i < 3; ++i) *at++ = vector[i];
    return array;
}

py::array_t<int> arrayOf(const std::vector<int>& values)
{
    return py::array_t<int>(py::ssize_t(values.size()), values.data());
}

py::array_t<int> rowsOf(const std::vector<int>& values, int columns)
{
    return py::array_t<int>(Dims{py::ssize_t(values.size()) / columns, columns}, values.data());
}

Doubles arrayToFill(py::handle out, const Dims& shape)
{
    if (out.is_none()) return Doubles(shape);
    if (!py::isinstance<py::array>(out))
        throw py::type_error("out is " + reprOf(out) + ": it must be None or a float64 array of shape " +
                             textOf(shape));
    const auto array = py::reinterpret_borrow<py::array>(out);
    if (!py::array_t<double>::check_(out))
        throw py::type_error("out has dtype " + nameOf(array.dtype()) +
                             ": it must be float64 in this machine's byte order");
    checkShape(array, "out", shape);
    if (!array.writeable()) throw py::value_error("out is read-only: it must be writable");
    if (!(array.flags() & py::array::c_style)) throw py::value_error("out is not contiguous: it must be");
    return py::reinterpret_borrow<Doubles>(array);
}

}  // namespace bullet_fem::python
