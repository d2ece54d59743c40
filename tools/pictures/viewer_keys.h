// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>
#include <vector>

namespace bullet_fem
{

/// Actions of keys; viewerKeys gives the keys.
enum class ViewerKey
{
    pause,
    step,
    earlier,
    later,
    box,
    ball,
    forces,
    stress,
    film,
    cancel,
    wireframe,
    resetView,
    panel,
    help,
    close
};

/// A line of the help.
struct ViewerHelp
{
    std::string m_keys, m_meaning;
};

/// All keys, in the order of ViewerKey.
const std::vector<ViewerHelp>& viewerKeys();

/// Help on mouse and files.
const std::vector<ViewerHelp>& viewerMouse();

/// Both as text for the command line, one line each.
std::string viewerHelpText();

}  // namespace bullet_fem
