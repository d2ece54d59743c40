// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <pybind11/numpy.h>

#include <initializer_list>
#include <string>
#include <vector>

#include "LinearMath/btTransform.h"
#include "bullet_fem/fem/common/vec3.h"

/// Python's objects as numbers and arrays, and back. pybind11 converts complex, object and big-endian arrays, and
/// floats for indices, without a word; these functions refuse them. All throw TypeError or ValueError with the
/// argument's name, the value found and the value expected.
namespace bullet_fem::python
{

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style>;
using Dims = std::vector<py::ssize_t>;

constexpr double kLargest = 1e6;            ///< largest coordinate that a body may have [m]
constexpr double kLargestStiffness = 1e12;  ///< of cables and springs [N/m], their damping [N s/m] and force [N]

/// A finite contiguous array of this shape, where -1 stands for any length. Copies only if it must.
Doubles doublesOf(py::handle object, const char* name, const Dims& shape);

/// A one-dimensional array of indices in [0, limit).
std::vector<int> indicesOf(py::handle object, const char* name, int limit);
/// An array of indices in [0, limit) with `columns` columns, row by row.
std::vector<int> indexRowsOf(py::handle object, const char* name, int columns, int limit);
/// A one-dimensional array of labels, of any value of an int.
std::vector<int> labelsOf(py::handle object, const char* name);

/// A finite number in [low, high].
double numberOf(py::handle object, const char* name, double low, double high);

btVector3 vectorOf(py::handle object, const char* name, double largest = kLargest);
/// A vector that is not 0.
btVector3 directionOf(py::handle object, const char* name);
/// A quaternion (x, y, z, w), which is normalized.
btQuaternion quaternionOf(py::handle object, const char* name);
btTransform transformOf(py::handle position, py::handle orientation);
/// Rows of three numbers, each in [-largest, largest].
std::vector<Vec3> vectorsOf(py::handle object, const char* name, py::ssize_t rows = -1, double largest = kLargest);

Doubles arrayOf(const btVector3& vector);
Doubles arrayOf(const btQuaternion& quaternion);
Doubles arrayOf(const std::vector<Vec3>& vectors);
py::array_t<int> arrayOf(const std::vector<int>& values);
/// Rows of indices.
py::array_t<int> rowsOf(const std::vector<int>& values, int columns);

/// The array to be filled: `out`, if it is not None, else a fresh one. `out` must be a writable, contiguous and native
/// float64 array of this shape.
Doubles arrayToFill(py::handle out, const Dims& shape);

/// "(3, n)" of a shape.
std::string textOf(const Dims& shape);

}  // namespace bullet_fem::python
