// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// Each report flag has a text.
#include "bullet_fem/btFemFlagText.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "bullet_fem/btFemReports.h"

namespace bullet_fem
{
namespace
{

TEST(FlagText, IsThereForEveryFlagOfTheHeader)
{
    std::ifstream file(BULLETFEM_REPORTS_HEADER);
    const std::string header(std::istreambuf_iterator<char>(file), {});
    const std::regex flag(R"((BT_FEM_\w+) = 1 << (\d+))");
    std::set<std::string> titles, explanations;
    int count = 0;
    for (std::sregex_iterator found(header.begin(), header.end(), flag), end; found != end; ++found, ++count)
    {
        const std::string name = (*found)[1];
        const btFemFlagText* const text = btFemFlagText::find(1 << std::stoi((*found)[2]));
        ASSERT_TRUE(text) << name << " has no words in plugin/record/btFemFlagText.cpp";
        EXPECT_EQ(text->m_name, name);
        EXPECT_EQ(text->m_flag, 1 << std::stoi((*found)[2]));
        const std::string title = text->m_title, explanation = text->m_explanation;
        EXPECT_LE(title.size(), 30u) << title << ": the window's panel has a line for it";
        EXPECT_GT(explanation.size(), 60u) << name;
        EXPECT_EQ(explanation.back(), '.') << name;
        titles.insert(title);
        explanations.insert(explanation);
    }
    EXPECT_GE(count, 27);
    EXPECT_EQ(titles.size(), std::size_t(count)) << "titles are distinct";
    EXPECT_EQ(explanations.size(), std::size_t(count));
}

TEST(FlagText, IsNullForUnknownOrCombinedFlags)
{
    for (const int none : {0, -1, 1 << 30, BT_FEM_NOT_CONVERGED | BT_FEM_BREAKDOWN})
        EXPECT_EQ(btFemFlagText::find(none), nullptr) << none;
}

}  // namespace
}  // namespace bullet_fem
