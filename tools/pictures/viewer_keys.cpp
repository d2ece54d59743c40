// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/viewer_keys.h"

#include <algorithm>

namespace bullet_fem
{
namespace
{

constexpr std::size_t kKeyColumn = 20;  // letters

}  // namespace

const std::vector<ViewerHelp>& viewerKeys()
{
    static const std::vector<ViewerHelp> keys = {
        {"Space", "pause, run"},
        {"Right arrow", "one step"},
        {"Left arrow, comma", "back in time, to the previous stored state"},
        {"Full stop", "forward, to the next stored state"},
        {"B", "drop a box at the mouse position"},
        {"O", "drop a ball at the mouse position"},
        {"C", "contact forces"},
        {"S", "stress"},
        {"F", "start a film, stop it"},
        {"X", "cancel opening a file"},
        {"W", "edges of triangles"},
        {"R", "reset the view"},
        {"H", "hide the panel, show it"},
        {"F1", "these keys"},
        {"Escape", "close"},
    };
    return keys;
}

const std::vector<ViewerHelp>& viewerMouse()
{
    static const std::vector<ViewerHelp> mouse = {
        {"Left button", "pulls a soft body; elsewhere turns the view"},
        {"Right, middle button", "moves the view"},
        {"Wheel", "nearer, farther"},
        {"A file dropped here", "becomes a soft body: a surface or tetrahedra"},
    };
    return mouse;
}

std::string viewerHelpText()
{
    std::string text;
    for (const auto* lines : {&viewerKeys(), &viewerMouse()})
        for (const ViewerHelp& line : *lines)
        {
            std::string keys = line.m_keys;
            keys.resize(std::max(keys.size() + 2, kKeyColumn + 2), ' ');
            text += "  " + keys + line.m_meaning + "\n";
        }
    return text;
}

}  // namespace bullet_fem
