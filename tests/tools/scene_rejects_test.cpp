// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Each kind of bad scene gives a message with the path in the document, the found and the expected value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tools/scene/scene_reader.h"
#include "tools/scene_samples.h"

namespace bullet_fem
{
namespace
{

using nlohmann::json;

/// `m_value`, as JSON, replaces `m_at` in one of the sample scenes; "" removes it.
struct BadValue
{
    const char* m_test;
    bool m_full;  ///< in fullScene, else in otherScene
    const char* m_at;
    const char* m_value;
    const char* m_message;  ///< the whole message
};

void PrintTo(const BadValue& bad, std::ostream* out)
{
    *out << bad.m_at << " = " << bad.m_value;
}

class RejectedScene : public testing::TestWithParam<BadValue>
{
};

TEST_P(RejectedScene, NamesPlaceFaultAndReason)
{
    const TemporaryFolder folder;
    writeSampleMeshes(folder);
    const BadValue& bad = GetParam();
    json scene = json::parse(bad.m_full ? fullScene() : otherScene());
    const json::json_pointer at(bad.m_at);
    if (*bad.m_value)
        scene[at] = json::parse(bad.m_value);
    else
        scene[at.parent_pointer()].erase(at.back());
    const std::string message = messageOf<std::runtime_error>(
        [&] { parseScene(scene.dump(), folder.path("").substr(0, folder.path("").size() - 1)); });
    std::string expected = bad.m_message;
    if (const std::size_t place = expected.find("FOLDER"); place != std::string::npos)
        expected.replace(place, 6, folder.path("").substr(0, folder.path("").size() - 1));
    EXPECT_EQ(message, expected);
}

const BadValue kUnknown[] = {
    {"InTheDocument", true, "/gravitation", "1",
     "the document has a member 'gravitation', which is not known; those that are: $schema, title, gravity, step, "
     "seconds, framesPerSecond, solver, materials, softBodies, rigidBodies, constraints, welds, forces, springs, "
     "actuators, sensors, camera, pictures"},
    {"InSolver", true, "/solver/iterations", "1",
     "solver has a member 'iterations', which is not known; those that are: coupled, tolerance, contactTolerance, "
     "threads"},
    {"InAMaterial", true, "/materials/gum/nu", "1",
     "materials.gum has a member 'nu', which is not known; those that are: like, shoreA, shoreD, young, poisson, "
     "density, massDamping, stiffnessDamping, loss, meanDilatation, bending, yieldStress, hardening, "
     "plasticCreep, mostPlasticStrain, relaxation, law, lawConstants, orthotropic"},
    {"InASoftBody", true, "/softBodies/1/mass", "1",
     "softBodies[1] has a member 'mass', which is not known; those that are: name, mesh, position, rotation, velocity, "
     "material, materials, friction, restitution, selfContact, colour, pins, pieces, fracture, copies"},
    {"InAMesh", true, "/softBodies/0/mesh/boxes", "1",
     "softBodies[0].mesh has a member 'boxes', which is not known; those that are: box, sphere, cylinder, surface, "
     "tetrahedra, baked, holes, cell, tets, grade, levels, scale, surfaceCollides"},
    {"InARotation", true, "/softBodies/0/rotation/angle", "1",
     "softBodies[0].rotation has a member 'angle', which is not known; those that are: axis, degrees"},
    {"InAPin", true, "/softBodies/0/pins/1/middle", "1",
     "softBodies[0].pins[1] has a member 'middle', which is not known; those that are: low, high"},
    {"InARigidBody", true, "/rigidBodies/0/density", "1",
     "rigidBodies[0] has a member 'density', which is not known; those that are: name, shape, mass, position, "
     "rotation, "
     "velocity, spin, friction, restitution, colour, copies"},
    {"InAShape", true, "/rigidBodies/1/shape/cone", "1",
     "rigidBodies[1].shape has a member 'cone', which is not known; those that are: plane, box, sphere, cylinder, "
     "capsule"},
    {"InACapsule", true, "/rigidBodies/0/shape/capsule/length", "1",
     "rigidBodies[0].shape.capsule has a member 'length', which is not known; those that are: radius, height"},
    {"InAnAnchor", true, "/constraints/0/pivot", "[0,0,0]",
     "constraints[0] has a member 'pivot', which is not known; those that are: kind, soft, rigid, nodes"},
    {"InAHinge", true, "/constraints/1/soft", "1",
     "constraints[1] has a member 'soft', which is not known; those that are: kind, body, to, pivot, axis, speed, "
     "torque, force"},
    {"InFracture", false, "/softBodies/4/fracture/strength", "3",
     "softBodies[4].fracture has a member 'strength', which is not known; those that are: tension, mostCracks, "
     "partsTouch"},
    {"InPieces", false, "/softBodies/3/pieces/count", "3",
     "softBodies[3].pieces has a member 'count', which is not known; those that are: cells, seed, breakForce, "
     "breakStress, breakStretch, compliance"},
    {"InAWeld", true, "/welds/0/strength", "1",
     "welds[0] has a member 'strength', which is not known; those that are: a, b, reach, breakForce, breakStress, "
     "breakStretch, compliance"},
    {"InAForce", true, "/forces/0/until", "1",
     "forces[0] has a member 'until', which is not known; those that are: body, nodes, force, from, to"},
    {"InASpring", true, "/springs/0/node", "1",
     "springs[0] has a member 'node', which is not known; those that are: body, at, target, stiffness, damping, force, "
     "from, to"},
    {"InASensor", true, "/sensors/0/node", "1",
     "sensors[0] has a member 'node', which is not known; those that are: name, body, nodes, to, about"},
    {"InTheCamera", true, "/camera/zoom", "1",
     "camera has a member 'zoom', which is not known; those that are: direction, eye, target, fieldOfView"},
    {"InPictures", true, "/pictures/size", "1",
     "pictures has a member 'size', which is not known; those that are: width, height, stress, hottest, forces, "
     "wireframe"},
};

const BadValue kWrongKind[] = {
    {"TextForANumber", true, "/step", R"("0.01")", "step is \"0.01\"; it must be a number in [1e-06, 1]"},
    {"NaNAsText", true, "/seconds", R"("NaN")", "seconds is \"NaN\"; it must be a number in (0, 100000]"},
    {"NullForANumber", true, "/step", "null", "step is null; it must be a number in [1e-06, 1]"},
    {"FlagForANumber", true, "/softBodies/0/friction", "true",
     "softBodies[0].friction is true; it must be a number in [0, 10]"},
    {"NumberForAFlag", true, "/softBodies/0/selfContact", "1",
     "softBodies[0].selfContact is 1; it must be true or false"},
    {"NumberForAText", true, "/softBodies/0/name", "7",
     "softBodies[0].name is 7; it must be a text in quotes, not empty"},
    {"EmptyText", true, "/softBodies/0/name", R"("")",
     "softBodies[0].name is \"\"; it must be a text in quotes, not empty"},
    {"SchemaThatIsNoText", true, "/$schema", "3", "$schema is 3; it must be a text in quotes, not empty"},
    {"NumberForAVector", true, "/gravity", "9.81", "gravity is 9.81; it must be an array of three numbers"},
    {"TwoNumbersForAVector", true, "/gravity", "[0,1]", "gravity is [0,1]; it must be an array of three numbers"},
    {"TextInAVector", true, "/gravity", R"([0,"1",0])", "gravity[1] is \"1\"; it must be a number in [-10000, 10000]"},
    {"ObjectForAnArray", true, "/softBodies", "{}", "softBodies is {}; it must be an array, in []"},
    {"ArrayForAnObject", true, "/camera", "[]",
     "camera is []; it must be an object with direction, eye, target, fieldOfView"},
    {"ArrayForMaterials", true, "/materials", "[]", "materials is []; it must be an object, in {}"},
    {"NumberInAnArrayOfBodies", true, "/softBodies/1", "3",
     "softBodies[1] is 3; it must be an object with name, mesh, position, rotation, velocity, material, materials, "
     "friction, restitution, selfContact, colour, pins, pieces, fracture, copies"},
    {"FractionForAWholeNumber", true, "/solver/threads", "1.5",
     "solver.threads is 1.5; it must be a whole number in [1, 64]"},
    {"KindThatIsNone", true, "/constraints/0/kind", R"("glue")",
     "constraints[0].kind is \"glue\"; it must be one of: anchor, point, hinge, slider"},
    {"LongTextsAreCut", true, "/step", R"("0123456789012345678901234567890123456789012345678901234567890")",
     "step is \"012345678901234567890123456789012345...; it must be a number in [1e-06, 1]"},
};

const BadValue kOutOfRange[] = {
    {"Gravity", true, "/gravity", "[0,20000,0]", "gravity[1] is 20000; it must be a number in [-10000, 10000]"},
    {"StepOfNothing", true, "/step", "0", "step is 0; it must be a number in [1e-06, 1]"},
    {"NegativeSeconds", true, "/seconds", "-1", "seconds is -1; it must be a number in (0, 100000]"},
    {"Frames", true, "/framesPerSecond", "0", "framesPerSecond is 0; it must be a number in [0.01, 10000]"},
    {"Tolerance", true, "/solver/tolerance", "0.6", "solver.tolerance is 0.6; it must be a number in [1e-08, 0.5]"},
    {"ContactTolerance", true, "/solver/contactTolerance", "1",
     "solver.contactTolerance is 1; it must be a number in [1e-07, 0.1]"},
    {"Threads", true, "/solver/threads", "0", "solver.threads is 0; it must be a whole number in [1, 64]"},
    {"YieldStress", true, "/materials/gum/yieldStress", "0",
     "materials.gum.yieldStress is 0; it must be a number in (0, 1e+13]"},
    {"ShoreA", true, "/materials/tyre/shoreA", "96", "materials.tyre.shoreA is 96; it must be a number in [10, 95]"},
    {"ShoreD", true, "/materials/roller/shoreD", "20",
     "materials.roller.shoreD is 20; it must be a number in [30, 70]"},
    {"TwoHardnesses", true, "/materials/tyre/shoreD", "50",
     "materials.tyre has two of 'like', 'shoreA' and 'shoreD', which give all values; give one"},
    {"HardnessAndLike", true, "/materials/tyre/like", R"("rubber")",
     "materials.tyre has two of 'like', 'shoreA' and 'shoreD', which give all values; give one"},
    {"LossFactor", true, "/materials/timber/loss/factor", "3",
     "materials.timber.loss.factor is 3; it must be a number in [0, 2]"},
    {"LossAndStiffnessDamping", true, "/materials/timber/stiffnessDamping", "0.01",
     "materials.timber has both 'loss' and 'stiffnessDamping', which the loss factor determines; give one"},
    {"LossBelowThatOfTheMassDamping", true, "/materials/timber/massDamping", "100",
     "materials.timber.loss is no damping: loss factor [-] is 0.02 at 40 Hz, less than the 0.3978873577 of the mass "
     "damping alone; reduce the mass damping"},
    {"MostPlasticStrain", true, "/materials/gum/mostPlasticStrain", "1",
     "materials.gum.mostPlasticStrain is 1; it must be a number in (0, 0.9]"},
    {"RelaxationShare", true, "/materials/gum/relaxation/0/share", "1",
     "materials.gum.relaxation[0].share is 1; it must be a number in (0, 0.99]"},
    {"RelaxationShares", true, "/materials/gum/relaxation",
     R"([{ "share": 0.5, "time": 1 }, { "share": 0.5, "time": 2 }])",
     "materials.gum.relaxation has shares whose sum is more than 0.99; a solid keeps some"},
    {"RelaxationTerms", true, "/materials/gum/relaxation",
     R"([{ "share": 0.1, "time": 1 }, { "share": 0.1, "time": 2 }, { "share": 0.1, "time": 3 }, { "share": 0.1, "time": 4 }])",
     R"(materials.gum.relaxation is [{"share":0.1,"time":1},{"share":0.1,...; it must be an array of at most 3 terms)"},
    {"OrthotropicYoung", true, "/materials/timber/orthotropic/young/1", "0",
     "materials.timber.orthotropic.young[1] is 0; it must be a number in (0, 1e+13]"},
    {"OrthotropicPoisson", true, "/materials/timber/orthotropic/poisson/0", "3",
     "materials.timber is no material: orthotropic nu12 [-] is 3, outside (-2.236067977, 2.236067977), which |nu12| < "
     "sqrt(E1 / E2) asks for; is it nu21 = nu12 E2 / E1 of your table?"},
    {"OrthotropicAxes", true, "/materials/timber/orthotropic/axes", "[[1, 0, 0]]",
     "materials.timber.orthotropic.axes is [[1,0,0]]; it must be an array of two directions, of axis 1 and of axis 2"},
    {"OrthotropicAxisOfNoLength", true, "/materials/timber/orthotropic/axes/1", "[0, 0, 0]",
     "materials.timber.orthotropic.axes[1] is [0,0,0]; it must have a length"},
    {"OrthotropicParallelAxes", true, "/materials/timber/orthotropic/axes/1", "[0, 0, -1]",
     "materials.timber is no material: orthotropic directions of axes 1 and 2 are (0, 0, 2) and (0, 0, -1), parallel; "
     "give for axis 2 one across axis 1"},
    {"OrthotropicAndALaw", true, "/materials/timber/law", "\"hooke\"",
     "materials.timber has both 'law' and 'orthotropic', which is a law; give one"},
    {"Young", true, "/materials/gum/young", "0", "materials.gum.young is 0; it must be a number in (0, 1e+13]"},
    {"Poisson", true, "/softBodies/0/material/poisson", "0.5",
     "softBodies[0].material.poisson is 0.5; it must be a number in [0, 0.499]"},
    {"Density", true, "/materials/gum/density", "-1",
     "materials.gum.density is -1; it must be a number in (0, 1000000]"},
    {"Box", true, "/softBodies/0/mesh/box", "[1,0,1]",
     "softBodies[0].mesh.box[1] is 0; it must be a number in (0, 1000000]"},
    {"Cell", true, "/softBodies/0/mesh/cell", "-0.1",
     "softBodies[0].mesh.cell is -0.1; it must be a number in (0, 1000000]"},
    {"Tets", true, "/softBodies/1/mesh/tets", "4",
     "softBodies[1].mesh.tets is 4; it must be a whole number in [5, 5000000]"},
    {"Scale", true, "/softBodies/1/mesh/scale", "0",
     "softBodies[1].mesh.scale is 0; it must be a number in (0, 1000000000]"},
    {"Colour", true, "/softBodies/0/colour", "[0,0,255]",
     "softBodies[0].colour[2] is 255; it must be a number in [0, 1]"},
    {"Axis", true, "/softBodies/0/rotation/axis", "[0,0,0]",
     "softBodies[0].rotation.axis is [0,0,0]; it must have a length"},
    {"Normal", false, "/rigidBodies/0/shape/plane", "[0,0,0]",
     "rigidBodies[0].shape.plane is [0,0,0]; it must have a length"},
    {"Radius", false, "/rigidBodies/1/shape/sphere", "-2",
     "rigidBodies[1].shape.sphere is -2; it must be a number in (0, 1000000]"},
    {"Mass", true, "/rigidBodies/0/mass", "-3", "rigidBodies[0].mass is -3; it must be a number in [0, 1000000000]"},
    {"Restitution", true, "/rigidBodies/0/restitution", "1.1",
     "rigidBodies[0].restitution is 1.1; it must be a number in [0, 1]"},
    {"Torque", true, "/constraints/1/torque", "-1", "constraints[1].torque is -1; it must be a number of at least 0"},
    {"FieldOfView", true, "/camera/fieldOfView", "180", "camera.fieldOfView is 180; it must be a number in [1, 150]"},
    {"Width", true, "/pictures/width", "9000", "pictures.width is 9000; it must be a whole number in [16, 8192]"},
    {"Cells", false, "/softBodies/3/pieces/cells", "1",
     "softBodies[3].pieces.cells is 1; it must be a whole number in [2, 100000]"},
    {"Tension", false, "/softBodies/4/fracture/tension", "0",
     "softBodies[4].fracture.tension is 0; it must be a number in (0, 1e+13]"},
    {"MostCracks", false, "/softBodies/4/fracture/mostCracks", "1001",
     "softBodies[4].fracture.mostCracks is 1001; it must be a whole number in [1, 1000]"},
    {"Seed", false, "/softBodies/3/pieces/seed", "-1",
     "softBodies[3].pieces.seed is -1; it must be a whole number in [0, 2147483647]"},
    {"BreakForce", true, "/welds/0/breakForce", "0", "welds[0].breakForce is 0; it must be a number in (0, 1e+12]"},
    {"BreakStress", true, "/welds/0/breakStress", "-1",
     "welds[0].breakStress is -1; it must be a number in (0, 1e+13]"},
    {"BreakStretch", true, "/welds/0/breakStretch", "2e6",
     "welds[0].breakStretch is 2000000.0; it must be a number in (0, 1000000]"},
    {"Compliance", true, "/welds/0/compliance", "1.5", "welds[0].compliance is 1.5; it must be a number in [0, 1]"},
    {"Reach", true, "/welds/0/reach", "0", "welds[0].reach is 0; it must be a number in (0, 1000]"},
    {"LowAboveHigh", true, "/softBodies/0/pins/0/low", "[0,10,0]",
     "softBodies[0].pins[0] has a 'low' above its 'high'"},
    {"ToBeforeFrom", true, "/forces/0/to", "0.25", "forces[0].to is before 'from'"},
    {"SpringToBeforeFrom", true, "/springs/0/to", "0.125", "springs[0].to is before 'from'"},
    {"SpringStiffness", true, "/springs/0/stiffness", "-1",
     "springs[0].stiffness is -1; it must be a number in [0, 1e+12]"},
    {"SpringTarget", true, "/springs/0/target/1/1/2", "1e7",
     "springs[0].target[1][1][2] is 10000000.0; it must be a number in [-1000000, 1000000]"},
    {"EyeInTheTarget", true, "/camera/eye", "[0,1,0]", "camera.target is where 'eye' is; they must differ"},
};

const BadValue kMeaning[] = {
    {"NoName", true, "/softBodies/0/name", "", "softBodies[0] lacks 'name'"},
    {"NoMesh", true, "/softBodies/0/mesh", "", "softBodies[0] lacks 'mesh'"},
    {"NoPivot", true, "/constraints/1/pivot", "", "constraints[1] lacks 'pivot'"},
    {"NoDegrees", true, "/softBodies/0/rotation/degrees", "", "softBodies[0].rotation lacks 'degrees'"},
    {"NameTwice", true, "/rigidBodies/1/name", R"("hammer")",
     "rigidBodies[1].name is \"hammer\"; it must be a name that no other body has"},
    {"NameOfASoftAndARigidBody", true, "/rigidBodies/0/name", R"("scan")",
     "rigidBodies[0].name is \"scan\"; it must be a name that no other body has"},
    {"UnknownMaterial", false, "/softBodies/0/material", R"("gold")",
     "softBodies[0].material is \"gold\"; it must be the name of a material: clay, flesh, foam, jelly, lead, "
     "mildFoam, rubber, wood"},
    {"UnknownMaterialAsKind", true, "/softBodies/0/material/like", R"("gold")",
     "softBodies[0].material.like is \"gold\"; it must be the name of a material: clay, flesh, foam, gum, jelly, "
     "lead, mildFoam, roller, rubber, timber, tyre, wood"},
    {"UnknownSoftBody", true, "/constraints/0/soft", R"("hammer")",
     "constraints[0].soft is \"hammer\"; it must be the name of a soft body"},
    {"UnknownRigidBody", true, "/constraints/1/to", R"("block")",
     "constraints[1].to is \"block\"; it must be the name of a rigid body"},
    {"UnknownBody", true, "/forces/0/body", R"("nobody")",
     "forces[0].body is \"nobody\"; it must be the name of a body"},
    {"SpringOfARigidBody", true, "/springs/0/body", R"("hammer")",
     "springs[0].body is \"hammer\"; it must be the name of a soft body"},
    {"SensorOfARigidBody", true, "/sensors/0/body", R"("hammer")",
     "sensors[0].body is \"hammer\"; it must be the name of a soft body"},
    {"SensorOfAnchorsToASoftBody", true, "/sensors/1/to", R"("scan")",
     "sensors[1].to is \"scan\"; it must be the name of a rigid body"},
    {"SensorOfPinsAndAnchors", true, "/sensors/0/to", R"("hammer")",
     "sensors[0].nodes is given with 'to', whose anchors are meant; give one of them"},
    {"NameOfTwoSensors", true, "/sensors/1/name", R"("clamp")",
     "sensors[1].name is \"clamp\"; it must be a name that no other sensor has"},
    {"SpringWithoutATarget", true, "/springs/0/target", "", "springs[0] lacks 'target'"},
    {"NodesOfARigidBody", true, "/forces/0/body", R"("hammer")",
     "forces[0].nodes is given, but only soft bodies have nodes"},
    {"MissingFile", true, "/softBodies/1/mesh/surface", R"("bunny.off")",
     "softBodies[1].mesh.surface names 'FOLDER/bunny.off', which is no file"},
    {"FolderForAFile", true, "/softBodies/1/mesh/surface", R"("..")",
     "softBodies[1].mesh.surface names 'FOLDER/..', which is no file"},
    {"TwoMeshes", true, "/softBodies/0/mesh/surface", R"("cube.off")",
     "softBodies[0].mesh must have one of: box, sphere, cylinder, surface, tetrahedra, baked"},
    {"NoMeshKind", true, "/softBodies/0/mesh/box", "",
     "softBodies[0].mesh must have one of: box, sphere, cylinder, surface, tetrahedra, baked"},
    {"CellAndTets", true, "/softBodies/0/mesh/tets", "500",
     "softBodies[0].mesh has 'cell' and 'tets'; give one of them"},
    {"Grade", true, "/softBodies/1/mesh/grade", "0.4",
     "softBodies[1].mesh.grade is 0.4; it must be a number in [0.5, 8]"},
    {"Levels", true, "/softBodies/1/mesh/levels", "7",
     "softBodies[1].mesh.levels is 7; it must be a whole number in [1, 6]"},
    {"GradeOfABox", true, "/softBodies/0/mesh/grade", "2",
     "softBodies[0].mesh.grade is given, but only cages around a surface are graded; leave it out"},
    {"CellOfAMeshFile", false, "/softBodies/0/mesh/cell", "0.1",
     "softBodies[0].mesh.cell is given, but the file has its elements; leave it out"},
    {"ScaleOfABakedBody", false, "/softBodies/1/mesh/scale", "2",
     "softBodies[1].mesh.scale is given, but a baked body has its size; leave it out, or bake it anew"},
    {"SurfaceOfAMeshFile", false, "/softBodies/1/mesh/surfaceCollides", "true",
     "softBodies[1].mesh.surfaceCollides is for a 'surface' with a cage around it; a baked body has it from baking"},
    {"RegionMaterialsOfABakedBody", false, "/softBodies/1/materials", R"({ "1": "foam" })",
     "softBodies[1].materials are given for regions, which only a 'tetrahedra' or 'surface' has; give 'material'"},
    {"RegionMaterialsAndMaterial", false, "/softBodies/2/material", R"("jelly")",
     "softBodies[2].materials are given with 'material'; give one of them"},
    {"NoRegionMaterials", false, "/softBodies/2/materials", "{}",
     "softBodies[2].materials is empty; give every region of the file a material"},
    {"RegionWithoutLabel", false, "/softBodies/2/materials", R"({ "upper": "gum" })",
     "softBodies[2].materials.upper must be called by the label of a region in the file, a whole number such as \"1\""},
    {"RegionTwice", false, "/softBodies/2/materials", R"({ "01": "foam", "1": "foam" })",
     "softBodies[2].materials.1 is of a region that has a material already"},
    {"RegionOfAnUnknownMaterial", false, "/softBodies/2/materials/1", R"("gold")",
     "softBodies[2].materials.1 is \"gold\"; it must be the name of a material: clay, flesh, foam, jelly, lead, "
     "mildFoam, rubber, wood"},
    {"MaterialOfABakedBody", false, "/softBodies/1/material", R"("jelly")",
     "softBodies[1].material is given for a baked body, which has its own; leave it out, or bake it anew"},
    {"TwoShapes", true, "/rigidBodies/1/shape/sphere", "1",
     "rigidBodies[1].shape must have one of: plane, box, sphere, cylinder, capsule"},
    {"RoundWithoutHeight", false, "/softBodies/4/mesh/cylinder/height", "",
     "softBodies[4].mesh.cylinder lacks 'height'"},
    {"GradeOfACylinder", false, "/softBodies/4/mesh/grade", "2",
     "softBodies[4].mesh.grade is given, but only cages around a surface are graded; leave it out"},
    {"MotionOverTimeOfAMass", true, "/rigidBodies/1/mass", "1",
     "rigidBodies[1].velocity is given over time for a body with a 'mass', which forces move; give what it starts "
     "with"},
    {"MotionAtATimeBefore", true, "/rigidBodies/1/spin/0/0", "-1",
     "rigidBodies[1].spin[0][0] is -1; it must be a number of at least 0"},
    {"MotionWithoutATime", true, "/rigidBodies/1/spin/0", "[[1,2,3]]",
     "rigidBodies[1].spin[0] is [[1,2,3]]; it must be a pair [seconds, value]"},
    {"HeavyPlane", false, "/rigidBodies/0/mass", "1",
     "rigidBodies[0].mass is given for a plane, which stands still; leave it out"},
    {"TorqueOfAPoint", false, "/constraints/0/torque", "1",
     "constraints[0].torque is given, but only a hinge has one; leave it out"},
    {"NoCells", false, "/softBodies/3/pieces/cells", "", "softBodies[3].pieces lacks 'cells'"},
    {"PiecesOfASurface", true, "/softBodies/1/pieces", R"({ "cells": 3 })",
     "softBodies[1].pieces are given, but what is embedded or baked is not cut; take a box, sphere, cylinder or "
     "tetrahedra"},
    {"ActuatorOfABodyInPieces", true, "/softBodies/0/pieces", R"({ "cells": 3 })",
     "actuators[0].body is a body in pieces; actuators are in bodies that are in one"},
    {"NoTension", false, "/softBodies/4/fracture/tension", "", "softBodies[4].fracture lacks 'tension'"},
    {"FractureOfASurface", true, "/softBodies/1/fracture", R"({ "tension": 3 })",
     "softBodies[1].fracture is given, but what is embedded does not split; take a box, sphere, cylinder or "
     "tetrahedra"},
    {"CableInABodyThatSplits", false, "/softBodies/0/fracture", R"({ "tension": 3 })",
     "actuators[0].body is a body that splits, which loses chambers and cables; leave out its 'fracture'"},
    {"ChamberInABodyThatSplits", true, "/softBodies/0/fracture", R"({ "tension": 3 })",
     "actuators[0].body is a body that splits, which loses chambers and cables; leave out its 'fracture'"},
    {"WeldOfARigidBody", true, "/welds/0/a", R"("hammer")",
     "welds[0].a is \"hammer\"; it must be the name of a soft body"},
    {"WeldToItself", true, "/welds/0/b", R"("block")", "welds[0].b is 'a', too; weld it to another body"},
    {"TorqueOfASlider", false, "/constraints/1/torque", "1",
     "constraints[1].torque is given, but only a hinge has one; leave it out"},
    {"ForceOfAHinge", true, "/constraints/1/force", "1",
     "constraints[1].force is given, but only a slider has one; leave it out"},
    {"SpeedOfAPoint", false, "/constraints/0/speed", "1",
     "constraints[0].speed is given, but only a hinge or slider has one; leave it out"},
    {"CopiesInAPlane", false, "/softBodies/5/copies/count", "[2,3]",
     "softBodies[5].copies.count is [2,3]; it must be an array of three whole numbers"},
    {"HalfACopy", false, "/softBodies/5/copies/count/1", "1.5",
     "softBodies[5].copies.count[1] is 1.5; it must be a whole number in [1, 100]"},
    {"TooManyCopies", false, "/softBodies/5/copies/count", "[100,100,100]",
     "softBodies[5].copies.count makes 1000000 bodies; at most 10000 are allowed"},
    {"FarCopies", false, "/softBodies/5/copies/spacing", "[1e6,0,6e5]",
     "softBodies[5].copies.spacing puts the last copy beyond 1e6 m; make it or 'count' smaller"},
    {"CopyOfAName", false, "/rigidBodies/2/name", R"("toy.4")",
     "rigidBodies[2].name is \"toy.4\"; it must be a name that no other body has"},
    {"NameOfACopy", false, "/rigidBodies/3/name", R"("toy")",
     "rigidBodies[3].name gives a copy the name 'toy.0', which another body has"},
    {"EyeWithoutTarget", true, "/camera/target", "", "camera needs both 'eye' and 'target', or 'direction'"},
    {"EyeAndDirection", true, "/camera/direction", "[1,0,0]", "camera has 'eye' and 'direction'; give one of them"},
};

std::string badValueName(const testing::TestParamInfo<BadValue>& info)
{
    return info.param.m_test;
}

INSTANTIATE_TEST_SUITE_P(Unknown, RejectedScene, testing::ValuesIn(kUnknown), badValueName);
INSTANTIATE_TEST_SUITE_P(WrongKind, RejectedScene, testing::ValuesIn(kWrongKind), badValueName);
INSTANTIATE_TEST_SUITE_P(OutOfRange, RejectedScene, testing::ValuesIn(kOutOfRange), badValueName);
INSTANTIATE_TEST_SUITE_P(Meaning, RejectedScene, testing::ValuesIn(kMeaning), badValueName);

std::string messageOfText(const std::string& text)
{
    return messageOf<std::runtime_error>([&] { parseScene(text, "."); });
}

TEST(SceneText, IsRejectedIfItIsNoScene)
{
    using testing::HasSubstr;
    using testing::StartsWith;
    EXPECT_THAT(messageOfText("[]"), StartsWith("the document is []; it must be an object with"));
    EXPECT_THAT(messageOfText("3"), StartsWith("the document is 3; it must be an object with"));
    EXPECT_EQ(messageOfText("{}"), "the document has neither 'softBodies' nor 'rigidBodies'; a scene needs a body");
    EXPECT_THAT(messageOfText("{ \"solver\": " + std::string(40, '[') + std::string(40, ']') + "}"),
                HasSubstr("nested deeper than 32 levels"));
}

TEST(SceneText, IsRejectedForARepeatedMember)
{
    EXPECT_EQ(messageOfText(R"({ "solver": {}, "softBodies": [{ "a": {}, "step": 1, "step": 1 }] })"),
              "line 1, column 54: the member \"step\" is there twice in one object, first in line 1; give every member "
              "once");
    EXPECT_EQ(messageOfText(R"({ "solver": { "title": 1 }, "title": "the same name elsewhere" })"),
              "solver has a member 'title', which is not known; those that are: coupled, tolerance, contactTolerance, "
              "threads");
}

TEST(SceneText, IsNotEchoedAtLength)
{
    EXPECT_LT(messageOfText("{ \"step\": 1" + std::string(100000, '0') + "x }").size(), 700u);
}

}  // namespace
}  // namespace bullet_fem
