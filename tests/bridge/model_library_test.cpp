// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_bridge/body/model_library.h"

#include <gtest/gtest.h>

#include "bridge/bridge_test_bodies.h"

namespace bullet_fem
{
namespace
{

class ModelLibraryTest : public ::testing::Test
{
protected:
    std::shared_ptr<const BodyModel> modelOf(const btSoftBody& body, const Material& material, double step = 1.0 / 60)
    {
        FactorInput input = factorInputOf(body);
        input.m_step = step;
        return m_library.model(m_library.restShape(tetMeshOf(body), material, filledFractionsOf(body)), input);
    }
    ModelLibrary m_library;
};

TEST_F(ModelLibraryTest, CopiesOfABodyElsewhereShareModelAndCompliance)
{
    const TestBox a, b({btScalar(37.3), btScalar(-12.1), 5});
    const auto first = modelOf(*a.m_body, Material()), second = modelOf(*b.m_body, Material());
    EXPECT_EQ(first, second);
    const auto compliance = m_library.compliance(first);
    EXPECT_EQ(compliance, m_library.compliance(second));
}

TEST_F(ModelLibraryTest, CopiesWithRoundedMassesShareModelAndNeighbours)
{
    const TestBox a;
    const auto shape = m_library.restShape(tetMeshOf(*a.m_body), Material(), filledFractionsOf(*a.m_body));
    FactorInput input = factorInputOf(*a.m_body);
    const auto model = m_library.model(shape, input);
    for (double& m : input.m_mass) m *= 1 + 1e-5;
    EXPECT_EQ(m_library.model(shape, input), model);
    input.m_mass[0] *= 1.01;
    EXPECT_NE(m_library.model(shape, input), model);
    const auto neighbours = m_library.restNeighbours(shape);
    EXPECT_EQ(m_library.restNeighbours(shape), neighbours);
}

TEST_F(ModelLibraryTest, StepRoundedToSinglePrecisionIsTheSameStep)
{
    const TestBox a;
    const auto model = modelOf(*a.m_body, Material(), 1.0 / 60);
    EXPECT_EQ(model, modelOf(*a.m_body, Material(), static_cast<double>(1.f / 60)));
    EXPECT_NE(model, modelOf(*a.m_body, Material(), 1.0001 / 60));
}

TEST_F(ModelLibraryTest, AnotherMaterialStepOrShapeIsAnotherModel)
{
    const TestBox a;
    TestBox stretched;
    stretched.m_body->scale(btVector3(1, 1, btScalar(1.01)));
    const auto model = modelOf(*a.m_body, Material());
    EXPECT_NE(model, modelOf(*a.m_body, Material::wood()));
    EXPECT_NE(model, modelOf(*a.m_body, Material(), 1.0 / 30));
    EXPECT_NE(model, modelOf(*stretched.m_body, Material()));
    TestBox hollow;
    storeFill(*hollow.m_body, 0, 0.5, 1.5);
    EXPECT_NE(model, modelOf(*hollow.m_body, Material()));
}

TEST_F(ModelLibraryTest, ModelsMadeElsewhereAreTakenInUnlessThereIsOneLikeThem)
{
    const TestBox a;
    const auto shape = m_library.restShape(tetMeshOf(*a.m_body), Material(), filledFractionsOf(*a.m_body));
    const FactorInput input = factorInputOf(*a.m_body);
    EXPECT_FALSE(m_library.find(shape, input));
    const auto first = BodyModel::create(shape, input), second = BodyModel::create(shape, input);
    EXPECT_EQ(m_library.adopt(first), first);
    EXPECT_EQ(m_library.adopt(second), first);
    EXPECT_EQ(m_library.find(shape, input), first);
    EXPECT_EQ(m_library.model(shape, input), first);
}

TEST_F(ModelLibraryTest, FactorsOfAnotherMaterialAreBorrowedAndNeverTakenForFresh)
{
    const TestBox a;
    const auto mesh = tetMeshOf(*a.m_body);
    const auto shape = m_library.restShape(mesh, Material(), {}),
               wooden = m_library.restShape(mesh, Material::wood(), {});
    const FactorInput input = factorInputOf(*a.m_body);
    const auto factored = BodyModel::create(shape, input);
    EXPECT_EQ(m_library.modelWithFactor(shape, input, factored), factored);
    const auto borrowed = m_library.modelWithFactor(wooden, input, factored);
    EXPECT_EQ(&borrowed->factor(), &factored->factor());
    EXPECT_EQ(borrowed->sharedShape(), wooden);
    EXPECT_EQ(m_library.modelWithFactor(wooden, input, factored), borrowed);  // copies share it
    EXPECT_FALSE(m_library.find(wooden, input));
    EXPECT_FALSE(m_library.findExact(wooden, input));
    const auto own = m_library.model(wooden, input);
    EXPECT_NE(own, borrowed);
    EXPECT_EQ(m_library.modelWithFactor(wooden, input, factored), own);  // this one fits better
}

TEST_F(ModelLibraryTest, ShapesMadeElsewhereAreTakenInUnlessThereIsOneLikeThem)
{
    const TestBox a;
    const auto first = std::make_shared<const RestShape>(tetMeshOf(*a.m_body), Material());
    const auto second = std::make_shared<const RestShape>(tetMeshOf(*a.m_body), Material());
    EXPECT_EQ(m_library.adoptShape(first, {}), first);
    EXPECT_EQ(m_library.adoptShape(second, {}), first);
    EXPECT_EQ(m_library.restShape(tetMeshOf(*a.m_body), Material(), {}), first);
}

TEST_F(ModelLibraryTest, ModelsDieWithTheirLastBody)
{
    const TestBox a;
    std::weak_ptr<const BodyModel> observed = modelOf(*a.m_body, Material());
    EXPECT_TRUE(observed.expired());
}

}  // namespace
}  // namespace bullet_fem
