// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/console/option_range.h"

#include "fem/common/message.h"

namespace bullet_fem
{

CLI::Validator inRange(double low, double high)
{
    const std::string range = message("in [", low, ", ", high, "]");
    const auto check = [low, high, range](const std::string& input)
    {
        double value = 0;
        const bool isNumber = CLI::detail::lexical_cast(input, value);
        if (isNumber && value >= low && value <= high) return std::string();
        return "is " + input + ", must be a number " + range;
    };
    return CLI::Validator(check, range);
}

}  // namespace bullet_fem
