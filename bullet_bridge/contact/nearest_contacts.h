// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace bullet_fem
{

/// Keeps the `most` (>= 0) contacts of smallest gap, with their entries in other lists, in their present order. Returns
/// false if there are no more than that. `order` is scratch.
template <class Contact, class... Others>
bool keepNearest(int most, std::vector<int>& order, std::vector<Contact>& contacts, std::vector<Others>&... others)
{
    if (static_cast<int>(contacts.size()) <= most) return false;
    order.resize(contacts.size());
    std::iota(order.begin(), order.end(), 0);
    const auto nearer = [&](int a, int b)
    { return contacts[a].m_gap != contacts[b].m_gap ? contacts[a].m_gap < contacts[b].m_gap : a < b; };
    std::nth_element(order.begin(), order.begin() + most, order.end(), nearer);
    order.resize(most);
    std::sort(order.begin(), order.end());
    for (int k = 0; k < most; ++k)
    {
        contacts[k] = contacts[order[k]];
        ((others[k] = others[order[k]]), ...);
    }
    contacts.resize(most);
    (others.resize(most), ...);
    return true;
}

}  // namespace bullet_fem
