// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <string>

namespace bullet_fem
{

/// Says on stdout how far a run is: a line that updates itself on a terminal, a line every tenth of the run elsewhere.
class ProgressLine
{
public:
    ProgressLine();

    /// `done` [-], in [0, 1], is the share of the run behind us; `text` is shown with it.
    void show(double done, const std::string& text);

    /// Ends the line.
    void finish();

private:
    bool m_onTerminal;
    int m_shown = -1;                    // hundredths or tenths that were last shown
    std::string::size_type m_width = 0;  // of the longest text, which a shorter one must overwrite
};

}  // namespace bullet_fem
