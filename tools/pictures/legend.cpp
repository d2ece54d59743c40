// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/legend.h"

#include <algorithm>
#include <cmath>

#include "tools/pictures/legend_text.h"

namespace bullet_fem
{
namespace
{

constexpr Colour kInk{0.16, 0.18, 0.22}, kPaper{1, 1, 1};
constexpr double kBarHeight = 0.42;     // of the picture
constexpr double kPaperOpacity = 0.72;  // lets the background shine through

/// Returns the lower edge of the paper [pixels].
double addColourBar(const PictureScene& scene, const PictureSize& size, Overlay& overlay)
{
    const double h = legendTextHeight(scene, size), pad = std::round(0.7 * h);
    const std::string title = legendTitle(scene.m_colourScale);
    const std::vector<LegendLabel> labels = legendLabels(scene.m_colourScale);
    double labelWidth = 0;
    for (const LegendLabel& label : labels) labelWidth = std::max(labelWidth, overlay.textWidth(label.m_text));

    const double barWidth = std::round(1.1 * h), barHeight = std::round(kBarHeight * size.m_height);
    const double inner = std::max(overlay.textWidth(title), barWidth + 0.7 * h + labelWidth);
    PictureRectangle paper{0, 0, std::round(inner + 2 * pad),
                           std::round(barHeight + 2 * pad + (title.empty() ? 0.6 : 2.1) * h)};
    paper.m_x = size.m_width - paper.m_width - std::round(1.2 * h);
    paper.m_y = std::round(1.2 * h);
    overlay.rectangle(paper, kPaper, kPaperOpacity);

    const double left = paper.m_x + pad, top = paper.m_y + paper.m_height - std::round(pad + 0.3 * h) - barHeight;
    overlay.text({left, paper.m_y + pad + 0.75 * h}, title, TextAlignment::left, kInk);
    overlay.colourBar({left, top, barWidth, barHeight});
    for (const LegendLabel& label : labels)
    {
        const double y = std::round(top + barHeight * (1 - label.m_share));
        overlay.rectangle({left + barWidth, y - 0.5, std::round(0.35 * h), 1}, kInk, 1);
        overlay.text({left + barWidth + 0.7 * h, y + 0.36 * h}, label.m_text, TextAlignment::left, kInk);
    }
    return paper.m_y + paper.m_height;
}

/// A shaft with a head drawn as thin columns, its tip at the right.
void addArrow(const PictureRectangle& area, const Colour& colour, Overlay& overlay)
{
    const double head = std::round(area.m_height), middle = area.m_y + 0.5 * area.m_height;
    const double shaft = std::max(2., std::round(0.25 * area.m_height));
    overlay.rectangle({area.m_x, middle - 0.5 * shaft, area.m_width - head, shaft}, colour, 1);
    for (double x = 0; x < head; ++x)
    {
        const double height = area.m_height * (1 - x / head);
        overlay.rectangle({area.m_x + area.m_width - head + x, middle - 0.5 * height, 1, height}, colour, 1);
    }
}

/// Adds the legend of the arrows with letters `h` high, below `above`. Returns the lower edge of the paper [pixels].
double addArrows(const PictureArrows& arrows, const PictureSize& size, double h, double above, Overlay& overlay)
{
    const double pad = std::round(0.7 * h), arrow = std::round(2.2 * h);
    const std::string title = legendTitle(arrows), range = legendRange(arrows);
    const double inner = std::max(overlay.textWidth(title), arrow + 0.7 * h + overlay.textWidth(range));
    PictureRectangle paper{0, above + std::round(1.2 * h), std::round(inner + 2 * pad), std::round(2 * pad + 2.6 * h)};
    paper.m_x = size.m_width - paper.m_width - std::round(1.2 * h);
    overlay.rectangle(paper, kPaper, kPaperOpacity);
    const double left = paper.m_x + pad;
    overlay.text({left, paper.m_y + pad + 0.75 * h}, title, TextAlignment::left, kInk);
    const double y = paper.m_y + pad + 1.6 * h;
    addArrow({left, y, arrow, std::round(0.8 * h)}, arrows.m_colour, overlay);
    overlay.text({left + arrow + 0.7 * h, y + 0.76 * h}, range, TextAlignment::left, kInk);
    return paper.m_y + paper.m_height;
}

}  // namespace

double legendTextHeight(const PictureSize& size)
{
    return std::clamp(std::round(std::min(size.m_height / 36., size.m_width / 40.)), 9., 48.);
}

double legendTextHeight(const PictureScene& scene, const PictureSize& size)
{
    return std::round(scene.m_textSize * legendTextHeight(size));
}

double captionHeight(const PictureSize& size)
{
    return std::round(2.3 * legendTextHeight(size));
}

void addLegend(const PictureScene& scene, const PictureSize& size, Overlay& overlay)
{
    const bool scalars = std::any_of(scene.m_meshes.begin(), scene.m_meshes.end(),
                                     [](const PictureMesh& mesh) { return !mesh.m_scalars.empty(); });
    const double h = legendTextHeight(scene, size);
    double lower = 0;
    if (scalars && scene.m_colourScale.m_legend) lower = addColourBar(scene, size, overlay);
    for (const PictureArrows& arrows : scene.m_arrows)
        if (!arrows.m_title.empty()) lower = addArrows(arrows, size, h, lower, overlay);
    if (!scene.m_title.empty()) overlay.text({1.2 * h, 1.9 * h}, scene.m_title, TextAlignment::left, kInk);
    double base = size.m_height - 1.2 * h;  // base line of the caption's last line, then of the lines above it
    for (std::size_t end = scene.m_caption.size(); end > 0; base -= 1.4 * h)
    {
        const std::size_t found = scene.m_caption.rfind('\n', end - 1);
        const std::size_t start = found == std::string::npos ? 0 : found + 1;
        overlay.text({1.2 * h, base}, scene.m_caption.substr(start, end - start), TextAlignment::left, kInk);
        end = start > 0 ? start - 1 : 0;
    }
}

}  // namespace bullet_fem
