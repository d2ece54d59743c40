// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/body/body_snapshot.h"

#include <algorithm>
#include <cmath>

#include "bullet_fem/fem/body/initial_stress.h"
#include "fem/body/step_scratch.h"
#include "fem/common/bounds.h"
#include "fem/common/byte_stream.h"
#include "fem/elements/model_elements.h"

namespace bullet_fem
{
namespace
{

constexpr double kFarthestNode = 1e6;    // [m] and [m/s]; Bullet's broad phase drops bodies beyond it
constexpr float kUnitTolerance = 1e-3F;  // on a quaternion's squared norm

template <class T>
void checkSize(const std::vector<T>& values, std::size_t size, const char* name)
{
    if (values.size() != size) reject(values.size(), " ", name, " where the body has ", size);
}

void checkVectors(const std::vector<Vec3>& values, std::size_t size, const char* name)
{
    checkSize(values, size, name);
    for (std::size_t i = 0; i < size; ++i)
        for (int c = 0; c < 3; ++c)
            if (!(std::fabs(values[i][c]) < kFarthestNode))
                reject("the ", name, " of node ", i, " have the component ", values[i][c], ", not in (-1e6, 1e6)");
}

void checkMasses(const std::vector<double>& mass)
{
    for (std::size_t i = 0; i < mass.size(); ++i)
        if (!(mass[i] > 0) || !std::isfinite(mass[i]) || !std::isfinite(1 / mass[i]))
            reject("the mass of node ", i, " is ", mass[i], " kg, not in (0, inf)");
}

void checkFlags(const std::vector<unsigned char>& flags, const char* name)
{
    for (std::size_t i = 0; i < flags.size(); ++i)
        if (flags[i] > 1) reject(name, " of node ", i, " is ", static_cast<int>(flags[i]), ", not 0 or 1");
}

void checkRotations(const BodySnapshot& s)
{
    for (std::size_t e = 0; e < s.m_elementRotation.size(); ++e)
    {
        const Quaternion& q = s.m_elementRotation[e];
        const float square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
        if (!(std::fabs(square - 1) <= kUnitTolerance))
            reject("the rotation of element ", e, " has the squared length ", square, ", not 1");
    }
    const Mat3 product = transposeTimes(s.m_bodyRotation, s.m_bodyRotation) - Mat3::identity();
    if (!(squaredNorm(product) <= double(kUnitTolerance)) || !(determinant(s.m_bodyRotation) > 0))
        reject("the body's rotation is none");
}

void checkPlasticStrain(const BodySnapshot& s, const BodyModel& model)
{
    constexpr double kMax = 1;  // Material::m_mostPlasticStrain is less
    const bool may = !model.shape().m_materials.yields();
    const std::size_t elements = may && s.m_plasticStrain.empty() ? 0 : model.mesh().tets().size();
    checkSize(s.m_plasticStrain, elements, "plastic strains");
    checkSize(s.m_equivalentPlasticStrain, elements, "equivalent plastic strains");
    for (std::size_t e = 0; e < elements; ++e)
    {
        const double square = contraction(s.m_plasticStrain[e], s.m_plasticStrain[e]);
        if (!(2.0 / 3 * square <= kMax)) reject("the plastic strain of element ", e, " is beyond 1");
        if (!(s.m_equivalentPlasticStrain[e] >= 0) || !std::isfinite(s.m_equivalentPlasticStrain[e]))
            reject("the equivalent plastic strain of element ", e, " is ", s.m_equivalentPlasticStrain[e],
                   ", not in [0, inf)");
    }
}

void checkRelaxedStrain(const BodySnapshot& s, const BodyModel& model)
{
    constexpr double kMax = 1e12;  // square of the maximum: larger strains put nodes beyond kFarthestNode
    const std::size_t terms = static_cast<std::size_t>(model.shape().m_materials.relaxationTerms());
    checkSize(s.m_relaxedStrain, terms * model.mesh().tets().size(), "relaxed strains");
    for (std::size_t k = 0; k < s.m_relaxedStrain.size(); ++k)
        if (!(contraction(s.m_relaxedStrain[k], s.m_relaxedStrain[k]) <= kMax))
            reject("the relaxed strain of element ", k / terms, " is beyond 1e6");
}

void checkLawHistory(const BodySnapshot& s, const BodyModel& model)
{
    const std::size_t count = static_cast<std::size_t>(model.shape().m_materials.historyCount());
    checkSize(s.m_lawHistory, count * model.mesh().tets().size(), "history variables");
    for (std::size_t k = 0; k < s.m_lawHistory.size(); ++k)
        if (!std::isfinite(s.m_lawHistory[k]))
            reject("a history variable of element ", k / count, " is ", s.m_lawHistory[k], ", not finite");
}

}  // namespace

namespace
{

void addOrthotropic(std::uint64_t& mark, const Orthotropic& orthotropic)
{
    for (const auto* constants : {&orthotropic.m_young, &orthotropic.m_poisson, &orthotropic.m_shear})
        for (const double value : *constants) addToMark(mark, value);
    for (const Vec3* direction : {&orthotropic.m_along, &orthotropic.m_across})
        for (int c = 0; c < 3; ++c) addToMark(mark, (*direction)[c]);
}

void addMaterial(std::uint64_t& mark, const Material& material)
{
    for (double value : {material.m_youngModulus, material.m_poissonRatio, material.m_density, material.m_massDamping,
                         material.m_stiffnessDamping})
        addToMark(mark, value);
    if (material.m_law != ElasticLaw::hooke) addToMark(mark, static_cast<int>(material.m_law));
    if (material.isOrthotropic()) addOrthotropic(mark, material.m_orthotropic);
    for (const double constant : material.m_lawConstants)
        if (constant != 0) addToMark(mark, constant);
    if (material.yields())
        for (double value : {material.m_yieldStress, material.m_hardeningModulus, material.m_plasticCreep,
                             material.m_mostPlasticStrain})
            addToMark(mark, value);
    for (int i = 0; i < material.relaxationTerms(); ++i)
        for (double value : {material.m_relaxation[i].m_share, material.m_relaxation[i].m_time}) addToMark(mark, value);
}

}  // namespace

std::uint64_t markOf(const ElementMaterials& materials)
{
    std::uint64_t mark = kEmptyMark;
    for (const MaterialRegion& region : materials.m_regions)
    {
        addMaterial(mark, region.m_material);
        addToMark(mark, static_cast<int>(region.m_material.m_meanDilatation));
        addToMark(mark, static_cast<int>(region.m_material.m_bending));
    }
    for (const int region : materials.m_regionOf) addToMark(mark, region);
    return mark;
}

std::uint64_t markOf(const RestShape& shape)
{
    std::uint64_t mark = kEmptyMark;
    for (const Vec3& X : shape.m_mesh.restPositions())
        for (int c = 0; c < 3; ++c) addToMark(mark, X[c]);
    for (const Tet& tet : shape.m_mesh.tets())
        for (int node : tet) addToMark(mark, node);
    for (const RestElement& element : shape.m_elements)
        for (double value : {element.m_volume, element.m_muVolume, element.m_lambdaVolume}) addToMark(mark, value);
    addMaterial(mark, shape.m_material);
    if (!shape.m_materials.isUniform()) addToMark(mark, markOf(shape.m_materials));
    if (!shape.m_patches.empty()) addToMark(mark, shape.m_patches.count());
    return mark;
}

BodySnapshot snapshotOf(const Body& body)
{
    const BodyState& state = body.m_state;
    BodySnapshot s;
    s.m_shapeMark = markOf(body.m_model->shape());
    s.m_path = body.m_model->factorReport().m_path;
    const FactorInput& input = body.m_model->factorInput();
    s.m_factor.m_step = input.m_step;
    if (input.m_mass != state.m_mass) s.m_factor.m_mass = input.m_mass;
    if (input.m_fixed != state.m_fixed) s.m_factor.m_fixed = input.m_fixed;
    s.m_complianceScale = body.m_workspace.scratch().m_complianceScale;
    s.m_presentSteps = body.m_workspace.scratch().m_presentSteps;
    s.m_x = state.m_x;
    s.m_v = state.m_v;
    s.m_mass = state.m_mass;
    s.m_fixed = state.m_fixed;
    s.m_lastIncrement = state.m_lastIncrement;
    for (const int lane : body.m_model->elements().m_lanes.m_lane)
        s.m_elementRotation.push_back(state.m_elementRotation[lane]);
    s.m_bodyRotation = state.m_bodyRotation;
    s.m_initialStress = state.m_initialStress;
    s.m_initialStressChanges = state.m_initialStressChanges;
    s.m_plasticStrain = state.m_plasticStrain;
    s.m_equivalentPlasticStrain = state.m_equivalentPlasticStrain;
    s.m_relaxedStrain = state.m_relaxedStrain;
    s.m_lawHistory = state.m_lawHistory;
    s.m_actuators = body.m_actuators;
    s.m_leastStep = state.m_leastStep;
    s.m_mostStep = state.m_mostStep;
    return s;
}

void check(const BodySnapshot& s, const BodyModel& model)
{
    const std::size_t n = model.nodeCount();
    const std::size_t rotations = model.mesh().tets().size();
    checkVectors(s.m_x, n, "positions");
    checkVectors(s.m_v, n, "velocities");
    for (const std::vector<Vec3>& increment : s.m_lastIncrement) checkVectors(increment, n, "velocity increments");
    checkSize(s.m_mass, n, "masses");
    checkMasses(s.m_mass);
    checkSize(s.m_fixed, n, "fixed flags");
    checkFlags(s.m_fixed, "the fixed flag");
    if (!s.m_factor.m_mass.empty()) checkSize(s.m_factor.m_mass, n, "masses of the factor");
    checkMasses(s.m_factor.m_mass);
    if (!s.m_factor.m_fixed.empty()) checkSize(s.m_factor.m_fixed, n, "fixed flags of the factor");
    checkFlags(s.m_factor.m_fixed, "the factor's fixed flag");
    if (!isUsableStep(s.m_factor.m_step)) reject("the factor's step is ", s.m_factor.m_step, " s, not in [1e-6, 1]");
    if (!(s.m_leastStep >= 0 && s.m_leastStep <= s.m_mostStep && isWithin(s.m_mostStep, 0, kLongestStep)))
        reject("the recent steps are from ", s.m_leastStep, " s to ", s.m_mostStep, " s, not in [0, 1]");
    if (s.m_path != FactorPath::full && s.m_path != FactorPath::lowMemory)
        reject("the kind of the factor is ", static_cast<int>(s.m_path), ", not 0 or 1");
    checkSize(s.m_elementRotation, rotations, "element rotations");
    checkRotations(s);
    checkPlasticStrain(s, model);
    checkRelaxedStrain(s, model);
    checkLawHistory(s, model);
    std::string why;
    if (!isInitialStress(model, s.m_initialStress, &why)) reject(why);
    if (!isInitialStress(model, s.m_actuators.m_ownStress, &why)) reject(why);
    s.m_actuators.validate(model.mesh());
    if (!(s.m_complianceScale > 0) || !std::isfinite(s.m_complianceScale))
        reject("the compliance scale is ", s.m_complianceScale, ", not in (0, inf)");
    if (s.m_presentSteps < 0) reject("the steps with the present compliance are ", s.m_presentSteps, ", not >= 0");
}

FactorInput factorInputOf(const BodySnapshot& s)
{
    FactorInput input = s.m_factor;
    if (input.m_mass.empty()) input.m_mass = s.m_mass;
    if (input.m_fixed.empty()) input.m_fixed = s.m_fixed;
    return input;
}

void restore(const BodySnapshot& s, Body& body)
{
    BodyState& state = body.m_state;
    state.m_x = s.m_x;
    state.m_v = s.m_v;
    state.m_mass = s.m_mass;
    state.m_fixed = s.m_fixed;
    state.m_lastIncrement = s.m_lastIncrement;
    const std::vector<int>& elementAt = body.m_model->elements().m_lanes.m_element;
    for (std::size_t lane = 0; lane < elementAt.size(); ++lane)
        state.m_elementRotation[lane] = s.m_elementRotation[elementAt[lane]];
    state.m_bodyRotation = s.m_bodyRotation;
    state.m_initialStress = s.m_initialStress;
    state.m_initialStressChanges = s.m_initialStressChanges;
    state.m_plasticStrain = s.m_plasticStrain;
    state.m_equivalentPlasticStrain = s.m_equivalentPlasticStrain;
    state.m_relaxedStrain = s.m_relaxedStrain;
    state.m_lawHistory = s.m_lawHistory;
    body.m_actuators = s.m_actuators;
    state.m_leastStep = s.m_leastStep;
    state.m_mostStep = s.m_mostStep;
    StepScratch& scratch = body.m_workspace.scratch();
    scratch.m_complianceScale = s.m_complianceScale;
    scratch.m_presentSteps = s.m_presentSteps;
    scratch.m_velocity = s.m_v;
    std::fill(scratch.m_push.begin(), scratch.m_push.end(), Vec3());
    scratch.m_isPushed = false;
    scratch.m_reactions.forget();
}

}  // namespace bullet_fem
