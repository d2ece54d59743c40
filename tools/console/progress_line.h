// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

namespace bullet_fem
{

/// Progress on stdout: a line that updates itself on a terminal, else a line for each tenth of the run.
class ProgressLine
{
public:
    ProgressLine();

    /// `done` is the completed fraction of the run [-], in [0, 1]; `text` is shown with it.
    void show(double done, const std::string& text);

    /// Ends the line.
    void finish();

private:
    bool m_onTerminal;
    int m_shown = -1;                    // last value shown, in hundredths or tenths
    std::string::size_type m_width = 0;  // of the longest text so far, which shorter ones must overwrite
};

}  // namespace bullet_fem
