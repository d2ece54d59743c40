// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "soak/minimise.h"

#include <algorithm>

namespace bullet_fem
{

std::vector<int> minimise(std::vector<int> all, const std::function<bool(const std::vector<int>&)>& fails, int maxRuns)
{
    int runs = 0;
    for (std::size_t part = std::max<std::size_t>(all.size() / 2, 1);; part = std::max<std::size_t>(part / 2, 1))
    {
        bool shrunk = false;
        for (std::size_t first = 0; first < all.size() && runs < maxRuns;)
        {
            std::vector<int> rest(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(first));
            const std::size_t end = std::min(first + part, all.size());
            rest.insert(rest.end(), all.begin() + static_cast<std::ptrdiff_t>(end), all.end());
            ++runs;
            if (fails(rest))
            {
                all = std::move(rest);
                shrunk = true;
            }
            else
                first = end;
        }
        if (runs >= maxRuns || (part == 1 && !shrunk)) return all;
    }
}

}  // namespace bullet_fem
