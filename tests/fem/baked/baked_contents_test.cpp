// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Baked files with right checksums and one invalid number are rejected.
#include <gmock/gmock.h>

#include <limits>

#include "fem/scenes/baked_files.h"
#include "fem/scenes/test_constants.h"

namespace bullet_fem
{
namespace
{

using testing::HasSubstr;

// Offset of a section in the file.
template <class Array>
std::size_t placeOf(const BakedHeader& header, Array BakedArrays::*wanted)
{
    BakedArrays arrays;
    std::size_t at = alignedBytes(sizeof header + sizeof(float) * header.m_panelFloats), place = 0;
    forEachSection(arrays, header,
                   [&](const auto& array, std::size_t count)
                   {
                       if (static_cast<const void*>(&array) == &(arrays.*wanted)) place = at;
                       at = alignedBytes(at + count * sizeof array[0]);
                   });
    return place;
}

class BakedContents : public testing::Test
{
protected:
    // The error message for the file with a replaced entry of a section.
    template <class Array, class Entry>
    std::string with(Array BakedArrays::*section, std::size_t index, const Entry& entry) const
    {
        std::string bytes = m_bytes;
        std::memcpy(&bytes[placeOf(header(), section) + index * sizeof entry], &entry, sizeof entry);
        return complaint(sealed(bytes));
    }

    // The error message for the file with a replaced value of its header.
    template <class Value>
    std::string with(Value BakedHeader::*member, const Value& value) const
    {
        BakedHeader changed = header();
        changed.*member = value;
        std::string bytes = m_bytes;
        std::memcpy(&bytes[0], &changed, sizeof changed);
        return complaint(sealed(bytes));
    }

    BakedHeader header() const
    {
        BakedHeader h = {};
        std::memcpy(&h, m_bytes.data(), sizeof h);
        return h;
    }

    std::string m_bytes = bytesOf(bakeCase());  // 12 nodes, 0 and 1 pinned
};

TEST_F(BakedContents, MeshArraysAreValidated)
{
    EXPECT_THAT(with(&BakedArrays::m_positions, 3, Vec3{kNaN, 0, 0}), HasSubstr("node 3"));
    EXPECT_THAT(with(&BakedArrays::m_tets, 1, -1), HasSubstr("uses node -1"));
    EXPECT_THAT(with(&BakedArrays::m_tets, 1, 12), HasSubstr("uses node 12"));
    EXPECT_THAT(with(&BakedArrays::m_sides, 2, char(16)), HasSubstr("sides 16"));
    EXPECT_THAT(with(&BakedArrays::m_filled, 0, 0.0), HasSubstr("filled fraction of element 0"));
    EXPECT_THAT(with(&BakedArrays::m_inverseMass, 5, 0.0), HasSubstr("inverse mass 0"));
    EXPECT_THAT(with(&BakedArrays::m_inverseMass, 5, 1e-320), HasSubstr("node 5"));
    EXPECT_THAT(with(&BakedArrays::m_fixed, 5, char(2)), HasSubstr("fixed flag of node 5 is 2"));
    EXPECT_THAT(with(&BakedArrays::m_fixed, 0, char(0)), HasSubstr("more free nodes"));
}

TEST_F(BakedContents, SurfaceArraysAreValidated)
{
    EXPECT_THAT(with(&BakedArrays::m_vertexTet, 1, -1), HasSubstr("embedded vertex 1"));
    EXPECT_THAT(with(&BakedArrays::m_vertexTet, 1, 10), HasSubstr("embedded vertex 1"));
    EXPECT_THAT(with(&BakedArrays::m_weights, 0, kNaN), HasSubstr("embedded vertex 0"));
    EXPECT_THAT(with(&BakedArrays::m_triangles, 2, 3), HasSubstr("vertex 3"));
}

TEST_F(BakedContents, FactorArraysAreValidated)
{
    EXPECT_THAT(with(&BakedArrays::m_order, 0, -1), HasSubstr("node -1"));
    EXPECT_THAT(with(&BakedArrays::m_order, 0, 12), HasSubstr("node 12"));
    EXPECT_THAT(with(&BakedArrays::m_order, 0, 1), HasSubstr("fixed"));
    EXPECT_THAT(with(&BakedArrays::m_diagonal, 0, -1.0), HasSubstr("diagonal entry -1"));
    EXPECT_THAT(with(&BakedArrays::m_supernodes, 0, 0), HasSubstr("0 columns"));
    EXPECT_THAT(with(&BakedArrays::m_supernodes, 0, 100), HasSubstr("100 columns"));
    EXPECT_THAT(with(&BakedArrays::m_supernodes, 1, -1), HasSubstr("-1 rows"));
    EXPECT_THAT(with(&BakedArrays::m_supernodes, 2, 0), HasSubstr("parent 0"));
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()})
    {
        std::string bytes = m_bytes;
        std::memcpy(&bytes[sizeof(BakedHeader) + 40], &bad, sizeof bad);
        EXPECT_THAT(complaint(sealed(bytes)), HasSubstr("not finite"));
    }
}

TEST_F(BakedContents, LowMemoryArraysAreValidated)
{
    m_bytes = bytesOf(bakeCase({{2, 1, 1}, FactorChoice::lowMemory, false}));
    EXPECT_THAT(with(&BakedArrays::m_restRowStart, 0, 1), HasSubstr("rows of A0 go from 1"));
    EXPECT_THAT(with(&BakedArrays::m_restRowStart, 1, 1000), HasSubstr("row 0 of A0"));
    EXPECT_THAT(with(&BakedArrays::m_restColumn, 0, 1), HasSubstr("column 1"));
    EXPECT_THAT(with(&BakedArrays::m_restColumn, 1, -1), HasSubstr("column -1"));
    EXPECT_THAT(with(&BakedArrays::m_restValues, 4, std::numeric_limits<float>::infinity()), HasSubstr("not finite"));
}

TEST_F(BakedContents, HeaderFieldsAreValidated)
{
    EXPECT_THAT(with(&BakedHeader::m_nodes, ~0u), HasSubstr("4294967295"));
    EXPECT_THAT(with(&BakedHeader::m_nodes, 3u), HasSubstr("3 nodes"));
    EXPECT_THAT(with(&BakedHeader::m_nodes, 1000u), HasSubstr("its sections take"));
    EXPECT_THAT(with(&BakedHeader::m_rows, header().m_rows + 100), HasSubstr("its sections take"));
    EXPECT_THAT(with(&BakedHeader::m_filled, 1u), HasSubstr("1 filled fractions"));
    EXPECT_THAT(with(&BakedHeader::m_freeNodes, 13u), HasSubstr("13 free nodes"));
    EXPECT_THAT(with(&BakedHeader::m_panelFloats, ~std::uint64_t(0)), HasSubstr("floats"));
    EXPECT_THAT(with(&BakedHeader::m_entries, ~std::uint64_t(0)), HasSubstr("entries"));
    EXPECT_THAT(with(&BakedHeader::m_lowMemory, 1u), HasSubstr("kind of factor"));
    EXPECT_THAT(with(&BakedHeader::m_singlePrecision, 2u), HasSubstr("kind of factor"));
    EXPECT_THAT(with(&BakedHeader::m_youngModulus, -1.0), HasSubstr("Young"));
    EXPECT_THAT(with(&BakedHeader::m_step, kNaN), HasSubstr("step"));
    EXPECT_THAT(with(&BakedHeader::m_massScale, 0.0), HasSubstr("mass scale"));
    EXPECT_THAT(with(&BakedHeader::m_meanDilatation, 3u), HasSubstr("mean dilatation is 3"));
    EXPECT_THAT(with(&BakedHeader::m_meanDilatation, 64u), HasSubstr("mean dilatation is 64"));
    std::array<char, 48> unending;
    unending.fill('x');
    EXPECT_THAT(with(&BakedHeader::m_backend, unending), HasSubstr("no meaning"));
    EXPECT_THAT(with(&BakedHeader::m_ordering, {'\n'}), HasSubstr("no meaning"));
}

// Three separate elements give three supernodes without rows below, so that any of them may be a parent of another.
TEST_F(BakedContents, SupernodeTreesAreInPostorder)
{
    std::vector<Vec3> X;
    for (int k = 0; k < 3; ++k)
        for (const Vec3& x : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}})
            X.push_back(x + Vec3{3.0 * k, 0, 0});
    m_bytes = bytesOf(bakeBody(TetMesh(X, {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}}), {}));
    ASSERT_EQ(header().m_supernodes, 3u);
    EXPECT_EQ(with(&BakedArrays::m_supernodes, 2, 1), "");  // the first as a child of the second
    EXPECT_THAT(with(&BakedArrays::m_supernodes, 2, 2), HasSubstr("does not follow"));
}

}  // namespace
}  // namespace bullet_fem
