// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/viewer_dialogs.h"

#include <imgui.h>

#include <algorithm>

#include "tools/pictures/legend.h"

namespace bullet_fem
{
namespace
{

constexpr float kDialogMargin = 14, kProgressWidth = 460, kSentenceWidth = 640;  // [pixels]
constexpr std::size_t kLongestSentence = 500;                                    // letters
constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_AlwaysAutoResize;

/// Places the next window with its lower edge `above` the caption [pixels].
void placeBelow(const PictureSize& size, double above)
{
    ImGui::SetNextWindowPos(
        {0.5f * static_cast<float>(size.m_width), static_cast<float>(size.m_height - captionHeight(size) - above)},
        ImGuiCond_Always, {0.5f, 1});
}

/// `width`, limited to the picture [pixels].
float atMost(float width, const PictureSize& size)
{
    return std::max(100.f, std::min(width, static_cast<float>(size.m_width) - 4 * kDialogMargin));
}

void showLines(const char* title, const std::vector<ViewerHelp>& lines)
{
    ImGui::TextDisabled("%s", title);
    if (!ImGui::BeginTable(title, 2, ImGuiTableFlags_SizingFixedFit)) return;
    ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed, 180);
    ImGui::TableSetupColumn("meaning", ImGuiTableColumnFlags_WidthFixed, 350);
    for (const ViewerHelp& line : lines)
    {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(line.m_keys.c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(line.m_meaning.c_str());
    }
    ImGui::EndTable();
}

/// Shortens long text at the start of a character.
std::string shortened(const std::string& utf8)
{
    if (utf8.size() <= kLongestSentence) return utf8;
    std::size_t end = kLongestSentence;
    while (end > 0 && (static_cast<unsigned char>(utf8[end]) & 0xc0u) == 0x80u) --end;
    return utf8.substr(0, end) + "...";
}

}  // namespace

void showHelp(ViewerControl& control, const PictureSize& size)
{
    if (!control.helpShown()) return;
    ImGui::SetNextWindowPos({0.5f * static_cast<float>(size.m_width), 0.5f * static_cast<float>(size.m_height)},
                            ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowBgAlpha(0.96f);
    ImGui::SetNextWindowFocus();  // in front of the panel and all others
    ImGui::Begin("help", nullptr, kPlain);
    showLines("Keys", viewerKeys());
    ImGui::Spacing();
    showLines("Mouse", viewerMouse());
    ImGui::Spacing();
    if (ImGui::Button("Close", {100, 0})) control.setHelpShown(false);
    ImGui::End();
}

double showProgress(const ViewerProgress& progress, const PictureSize& size, bool& cancelled)
{
    if (progress.m_text.empty()) return 0;
    placeBelow(size, 0);
    ImGui::Begin("progress", nullptr, kPlain);
    const float width = atMost(kProgressWidth, size);
    ImGui::PushTextWrapPos(width);
    ImGui::TextUnformatted(shortened(progress.m_text).c_str());
    ImGui::PopTextWrapPos();
    ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImVec4(0.36f, 0.52f, 0.76f, 1));
    ImGui::ProgressBar(static_cast<float>(progress.m_share), {width - 110, 0});
    ImGui::PopStyleColor();
    ImGui::SameLine();
    if (ImGui::Button("Cancel", {100, 0})) cancelled = true;
    const double height = static_cast<double>(ImGui::GetWindowHeight() + kDialogMargin);
    ImGui::End();
    return height;
}

void showSentences(const std::vector<std::string>& sentences, const PictureSize& size, double above)
{
    if (std::all_of(sentences.begin(), sentences.end(), [](const std::string& s) { return s.empty(); })) return;
    placeBelow(size, above);
    ImGui::SetNextWindowBgAlpha(0.92f);
    ImGui::Begin("sentences", nullptr, kPlain | ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(atMost(kSentenceWidth, size));
    for (const std::string& sentence : sentences)
        if (!sentence.empty()) ImGui::TextUnformatted(shortened(sentence).c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

void showFilming(const PictureSize& size)
{
    ImGui::SetNextWindowPos({0.5f * static_cast<float>(size.m_width), kDialogMargin}, ImGuiCond_Always, {0.5f, 0});
    ImGui::Begin("filming", nullptr, kPlain | ImGuiWindowFlags_NoInputs);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float radius = 0.3f * ImGui::GetTextLineHeight();
    ImGui::GetWindowDrawList()->AddCircleFilled({at.x + radius, at.y + 0.5f * ImGui::GetTextLineHeight()}, radius,
                                                IM_COL32(205, 30, 30, 255));
    ImGui::SetCursorScreenPos({at.x + 3.5f * radius, at.y});
    ImGui::TextUnformatted("Film: F stops it");
    ImGui::End();
}

}  // namespace bullet_fem
