// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Baked files with right checksums and random contents: each gives an error, or a body that can be stepped.
#include <gtest/gtest.h>

#include <random>

#include "bullet_fem/fem/contact/contact_solver.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/contact/compliance/compliance_cache.h"
#include "fem/factor/rest_factor.h"
#include "fem/scenes/baked_files.h"

namespace bullet_fem
{
namespace
{

/// Changes a file at random places.
class Mutator
{
public:
    explicit Mutator(std::string bytes) : m_bytes(std::move(bytes)) {}

    std::string mutated()
    {
        std::string bytes = m_bytes;
        // Half of the changes go to the header or behind the panels, which fill most of the file.
        BakedHeader header = {};
        std::memcpy(&header, bytes.data(), sizeof header);
        const std::size_t arrays = alignedBytes(sizeof header + sizeof(float) * header.m_panelFloats);
        for (int k = below(3); k >= 0; --k)
        {
            const std::size_t kind = below(4);
            const std::size_t begin = kind == 0 ? 64 : kind == 3 ? 256 : arrays;
            const std::size_t end = kind == 0 ? 256 : bytes.size();
            change(bytes, begin + below(end - begin - 8));
        }
        if (below(50) == 0) bytes.resize(sizeof header + below(bytes.size()));
        return sealed(bytes);
    }

private:
    std::size_t below(std::size_t count) { return m_random() % count; }

    void change(std::string& bytes, std::size_t place)
    {
        static const std::int32_t ints[] = {-1,        0, 1, 2, 3, 7, 12, 255, 1 << 20, 0x7FFFFFFF, -0x7FFFFFFF - 1,
                                            0x7FC00000};
        static const double doubles[] = {0, -1, 1e-300, 1e300, -1e9, 1e-9, 0.3, 1e30};
        const std::size_t kind = below(4);
        if (kind == 0) bytes[place] = static_cast<char>(bytes[place] ^ 1 << below(8));
        if (kind == 1) std::memcpy(&bytes[place / 4 * 4], &ints[below(12)], 4);
        if (kind == 2) std::memcpy(&bytes[place / 8 * 8], &doubles[below(8)], 8);
        if (kind == 3) bytes[place / 4 * 4] = static_cast<char>(below(16));
    }

    const std::string m_bytes;
    std::mt19937 m_random{1};
};

// Steps the body and reads compliances, to use the whole factor.
bool standsUse(const BakedBody& baked)
{
    Body body(baked.m_model);
    for (Vec3& force : body.m_loads.m_force) force = {0.1, 0, -1};
    StepSettings settings;
    settings.m_maxIterations = 5;
    bool finite = true;
    for (int k = 0; k < 2; ++k)
    {
        solveFreeMotion(body, settings);
        if (canFinishStep(body))
            finishStep(body, settings);
        else
            abandonStep(body);
        for (const Vec3& x : body.m_state.m_x) finite = finite && isFinite(x);
    }
    const auto cache = makeComplianceCache(baked.m_model);
    std::vector<int> nodes;
    for (const int i : baked.m_model->mesh().surfaceNodes())
        if (i % 3 == 0) nodes.push_back(i);
    cache->request(nodes);
    return finite;
}

class BakedMutations : public testing::TestWithParam<BakedCase>
{
};

TEST_P(BakedMutations, AreRefusedOrHarmless)
{
    Mutator mutator(bytesOf(bakeCase(GetParam())));
    int refused = 0, used = 0;
    for (int k = 0; k < 5000; ++k)
    {
        const std::string bytes = mutator.mutated();
        std::string why;
        const BakedBody body = readBakedBody(rawBytes(bytes), bytes.size(), "memory", &why);
        if (body.m_model)
        {
            ++used;
            ASSERT_TRUE(standsUse(body)) << k;
        }
        else
        {
            ++refused;
            ASSERT_NE(why.find("cannot read"), std::string::npos) << why;
        }
    }
    EXPECT_GT(refused, 500);  // both outcomes occur
    EXPECT_GT(used, 500);
}

INSTANTIATE_TEST_SUITE_P(Of, BakedMutations,
                         testing::Values(BakedCase{{3, 2, 2}, FactorChoice::full, true},
                                         BakedCase{{3, 2, 2}, FactorChoice::lowMemory, true}),
                         [](const auto& param) {
                             return param.param.m_choice == FactorChoice::full ? "TheFullFactor" : "TheLowMemoryFactor";
                         });

}  // namespace
}  // namespace bullet_fem
