// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "bullet_fem/fem/laws/law_table.h"
#include "bullet_fem/fem/mesh/elastomer.h"
#include "python/core/handles.h"
#include "python/core/materials.h"

namespace bullet_fem::python
{
namespace
{

constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Field
{
    const char* m_name;
    double Material::*m_member;
    double m_low, m_high;
    const char* m_text;
};

const Field kFields[] = {
    {"young_modulus", &Material::m_youngModulus, 1e-300, 1e13, "Young's modulus E [Pa], in (0, 1e13]."},
    {"poisson_ratio", &Material::m_poissonRatio, 0, 0.499, "Poisson's ratio nu [-], in [0, 0.499]."},
    {"density", &Material::m_density, 0, 1e6, "Density [kg/m3], in [0, 1e6]; 0 keeps the masses of the nodes."},
    {"mass_damping", &Material::m_massDamping, 0, 1e4, "Rayleigh damping of the mass, alpha [1/s], in [0, 1e4]."},
    {"stiffness_damping", &Material::m_stiffnessDamping, 0, 10,
     "Rayleigh damping of the stiffness, beta [s], in [0, 10]; initially 0.005."},
    {"yield_stress", &Material::m_yieldStress, 1e-300, kInfinite, "Yield stress [Pa], in (0, inf]; inf never yields."},
    {"hardening_modulus", &Material::m_hardeningModulus, 0, 1e13,
     "Growth of the yield stress over plastic strain [Pa]."},
    {"plastic_creep", &Material::m_plasticCreep, 1e-300, kInfinite,
     "Rate at which stress beyond the yield stress decays [1/s], in (0, inf]; inf: at once."},
    {"max_plastic_strain", &Material::m_mostPlasticStrain, 1e-300, 0.9, "Largest plastic strain [-], in (0, 0.9]."},
};

template <class Choice>
Choice choiceOf(const std::string& text, const char* name, std::initializer_list<const char*> texts)
{
    int index = 0;
    std::string all;
    for (const char* one : texts)
    {
        if (text == one) return static_cast<Choice>(index);
        all += (index++ == 0 ? "'" : ", '") + std::string(one) + "'";
    }
    throw py::value_error(std::string(name) + " is '" + text + "': it must be one of " + all);
}

void setRelaxation(Material& material, py::handle terms)
{
    const Doubles array = doublesOf(terms, "relaxation", {-1, 2});
    const py::ssize_t count = array.ndim() == 2 ? array.shape(0) : 0;
    if (count > Material::kMaxRelaxationTerms) throw py::value_error("relaxation has more than three terms");
    material.m_relaxation = {};
    for (py::ssize_t i = 0; i < count; ++i) material.m_relaxation[std::size_t(i)] = {array.at(i, 0), array.at(i, 1)};
}

Doubles relaxationOf(const Material& material)
{
    Doubles array(Dims{material.relaxationTerms(), 2});
    for (int i = 0; i < material.relaxationTerms(); ++i)
    {
        array.mutable_at(i, 0) = material.m_relaxation[std::size_t(i)].m_share;
        array.mutable_at(i, 1) = material.m_relaxation[std::size_t(i)].m_time;
    }
    return array;
}

template <class Class>
void addConstants(Class& material, const char* name, std::array<double, 3> Orthotropic::*member, const char* text)
{
    material.def_property(
        name,
        [member](const Material& self)
        {
            const std::array<double, 3>& value = self.m_orthotropic.*member;
            return arrayOf(btVector3(value[0], value[1], value[2]));
        },
        [member, name](Material& self, py::handle value)
        {
            const Doubles array = doublesOf(value, name, {3});
            self.m_orthotropic.*member = {array.at(0), array.at(1), array.at(2)};
        },
        text);
}

template <class Class>
void addAxis(Class& material, const char* name, Vec3 Orthotropic::*member, const char* text)
{
    material.def_property(
        name,
        [member](const Material& self)
        {
            const Vec3& value = self.m_orthotropic.*member;
            return arrayOf(btVector3(value.x, value.y, value.z));
        },
        [member, name](Material& self, py::handle value)
        {
            const btVector3 axis = directionOf(value, name);
            self.m_orthotropic.*member = {axis.x(), axis.y(), axis.z()};
        },
        text);
}

// neoHooke is neo_hooke in Python.
std::string pythonName(const std::string& law)
{
    std::string name;
    for (const char c : law)
        name += c >= 'A' && c <= 'Z' ? std::string("_") + static_cast<char>(c - 'A' + 'a') : std::string(1, c);
    return name;
}

ElasticLaw lawOfPythonName(const std::string& text)
{
    std::string name;
    for (std::size_t k = 0; k < text.size(); ++k)
        name += text[k] == '_' && k + 1 < text.size() ? static_cast<char>(text[++k] - 'a' + 'A') : text[k];
    ElasticLaw law = ElasticLaw::hooke;
    if (pythonName(name) != text || !findLaw(name, law))
        throw py::value_error("law is '" + text + "': it must be one of " + pythonName(listOfLaws()));
    return law;
}

std::map<std::string, double> lawConstantsOf(const Material& material)
{
    std::map<std::string, double> constants;
    for (std::size_t k = 0; k < constantsOf(material.m_law).size(); ++k)
        constants[constantsOf(material.m_law)[k].m_name] = material.m_lawConstants[k];
    return constants;
}

void setLawConstants(Material& material, const std::map<std::string, double>& values)
{
    const std::vector<LawConstant>& known = constantsOf(material.m_law);
    std::array<double, kMaxLawConstants> constants = {};
    for (std::size_t k = 0; k < known.size(); ++k)
        constants[k] = values.count(known[k].m_name) ? values.at(known[k].m_name) : known[k].m_default;
    for (const auto& [name, value] : values)
        if (std::none_of(known.begin(), known.end(), [&](const LawConstant& c) { return c.m_name == name; }))
            throw py::value_error("'" + name + "' is no constant of the law " + nameOf(material.m_law));
    material.m_lawConstants = constants;
}

// The constants become those of the law by default.
void setLaw(Material& material, ElasticLaw law)
{
    if (law == material.m_law) return;
    material.m_law = law;
    setLawConstants(material, {});
}

template <class Class>
void addChoices(Class& material)
{
    static const auto kDilatations = {"automatic", "on", "off"}, kBendings = {"automatic", "plain", "accurate"};
    material
        .def_property(
            "mean_dilatation",
            [](const Material& self) { return *(kDilatations.begin() + int(self.m_meanDilatation)); },
            [](Material& self, const std::string& text)
            { self.m_meanDilatation = choiceOf<MeanDilatation>(text, "mean_dilatation", kDilatations); },
            "Whether patches of elements share one volume change, against locking: 'automatic', 'on' or 'off'.")
        .def_property(
            "law", [](const Material& self) { return pythonName(nameOf(self.m_law)); },
            [](Material& self, const std::string& text) { setLaw(self, lawOfPythonName(text)); },
            "Constitutive law: 'hooke', 'neo_hooke', 'orthotropic' or another of docs/materials.md.")
        .def_property("law_constants", &lawConstantsOf, &setLawConstants,
                      "Constants of laws with constants of their own by name, a dict; set the law before them.")
        .def_property(
            "bending", [](const Material& self) { return *(kBendings.begin() + int(self.m_bending)); },
            [](Material& self, const std::string& text)
            { self.m_bending = choiceOf<Bending>(text, "bending", kBendings); },
            "Remedy against locking in bending: 'automatic' (in bodies with fewer than four cells across somewhere), "
            "'plain' or 'accurate'.")
        .def_property("relaxation", &relaxationOf, &setRelaxation,
                      "Prony series of the shear modulus, float64 (k, 2), k <= 3: shares [-] and times [s].");
    addConstants(material, "young_moduli", &Orthotropic::m_young, "E_1, E_2, E_3 of law 'orthotropic' [Pa], (3,).");
    addConstants(material, "poisson_ratios", &Orthotropic::m_poisson,
                 "nu_12, nu_13, nu_23 of law 'orthotropic' [-], (3,).");
    addConstants(material, "shear_moduli", &Orthotropic::m_shear, "G_12, G_13, G_23 of law 'orthotropic' [Pa], (3,).");
    addAxis(material, "along", &Orthotropic::m_along, "Axis 1 of law 'orthotropic' in the mesh, a direction (3,).");
    addAxis(material, "across", &Orthotropic::m_across, "Axis 2 of law 'orthotropic' in the mesh, a direction (3,).");
}

std::vector<double> valuesOf(py::handle object, const char* name)
{
    if (object.is_none()) return {};
    const Doubles array = doublesOf(object, name, {-1});
    return std::vector<double>(array.data(), array.data() + array.size());
}

void bindElementMaterials(py::module_& module)
{
    py::class_<ElementMaterials>(module, "ElementMaterials", py::module_local(),
                                 "Materials of a body's elements, given by arrays of one value per element.")
        .def(py::init(
                 [](const Material& base, py::handle young, py::handle poisson, py::handle density, py::handle along,
                    py::handle across)
                 {
                     ElementMaterials materials;
                     materials.m_base = base;
                     materials.m_young = valuesOf(young, "young_modulus");
                     materials.m_poisson = valuesOf(poisson, "poisson_ratio");
                     materials.m_density = valuesOf(density, "density");
                     if (!along.is_none()) materials.m_along = vectorsOf(along, "along");
                     if (!across.is_none()) materials.m_across = vectorsOf(across, "across");
                     return materials;
                 }),
             py::arg("base"), py::kw_only(), py::arg("young_modulus") = py::none(),
             py::arg("poisson_ratio") = py::none(), py::arg("density") = py::none(), py::arg("along") = py::none(),
             py::arg("across") = py::none(),
             "A base material whose values arrays replace: young_modulus (m,) [Pa], poisson_ratio (m,) [-], density "
             "(m,)\n"
             "[kg/m3], along and across (m, 3), the axes of law 'orthotropic'. None keeps the base's.")
        .def_static(
            "of_regions",
            [](py::handle labels, const std::map<int, Material>& materials)
            {
                ElementMaterials result;
                if (materials.empty()) throw py::value_error("materials is empty: it must have one for each label");
                result.m_labels = labelsOf(labels, "labels");
                if (result.m_labels.empty())
                    throw py::value_error("labels is empty: it must have one for each element");
                result.m_ofLabel = materials;
                result.m_base = materials.begin()->second;
                return result;
            },
            py::arg("labels"), py::arg("materials"),
            "A label for each element, integers (m,), such as Mesh.regions, and a dict of a material for each label.");
}

void addPresets(py::class_<Material>& material)
{
    const std::pair<const char*, Material (*)()> presets[] = {
        {"rubber", &Material::rubber}, {"foam", &Material::foam},         {"jelly", &Material::jelly},
        {"flesh", &Material::flesh},   {"wood", &Material::wood},         {"clay", &Material::clay},
        {"lead", &Material::lead},     {"mild_foam", &Material::mildFoam}};
    for (const auto& [name, make] : presets)
        material.def_static(
            name, [make = make] { return withProgramDefaults(make()); }, "A preset of docs/materials.md.");
    material
        .def_static(
            "shore_a", [](double hardness) { return withProgramDefaults(shoreA(hardness)); }, py::arg("hardness"),
            "Rubber of a hardness on Shore's scale A, in [10, 95].")
        .def_static(
            "shore_d", [](double hardness) { return withProgramDefaults(shoreD(hardness)); }, py::arg("hardness"),
            "Hard rubber or thermoplastic elastomer of a hardness on Shore's scale D, in [30, 70].");
}

}  // namespace

void bindMaterials(py::module_& module)
{
    py::class_<Material> material(module, "Material", py::module_local(),
                                  "An elastic material in SI units, for bodies and for baking.");
    material.def(py::init([] { return withProgramDefaults(Material()); }));
    for (const Field& field : kFields)
        material.def_property(
            field.m_name, [&field](const Material& self) { return self.*field.m_member; },
            [&field](Material& self, py::handle value)
            { self.*field.m_member = numberOf(value, field.m_name, field.m_low, field.m_high); },
            field.m_text);
    addChoices(material);
    material
        .def(py::init(
                 [](const py::kwargs& values)
                 {
                     py::object result = py::cast(withProgramDefaults(Material()));
                     for (const auto& [name, value] : values)
                     {
                         if (!py::hasattr(py::type::of<Material>(), name))
                             throw py::type_error("Material has no value " + std::string(py::repr(name)));
                         py::setattr(result, name, value);
                     }
                     result.cast<const Material&>().validate();
                     return result.cast<Material>();
                 }),
             "A material of the given values, which are those of the attributes.")
        .def(
            "validate", [](const Material& self) { self.validate(); },
            "Raises ValueError if values are out of range or contradict each other.")
        .def(
            "copy", [](const Material& self) { return self; }, "An independent copy.")
        .def("__copy__", [](const Material& self) { return self; })
        .def(
            "__deepcopy__", [](const Material& self, py::handle) { return self; }, py::arg("memo"))
        .def(
            "__eq__", [](const Material& self, const Material& other) { return self == other; }, py::is_operator())
        .def("__repr__",
             [](const Material& self)
             {
                 return py::str("Material(young_modulus={}, poisson_ratio={}, density={})")
                     .format(self.m_youngModulus, self.m_poissonRatio, self.m_density);
             });
    addPresets(material);
    material
        .def("set_loss_factor", &setLossFactor, py::arg("loss_factor"), py::arg("frequency"),
             "Sets stiffness_damping so that the loss factor [-] at a frequency [Hz] is this; mass_damping stays.")
        .def("loss_factor", &lossFactor, py::arg("frequency"), "The loss factor [-] at a frequency [Hz].");
    material.attr("__hash__") = py::none();
    bindElementMaterials(module);
}

}  // namespace bullet_fem::python
