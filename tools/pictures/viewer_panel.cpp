// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/viewer_panel.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <exception>
#include <stdexcept>

#include "tools/pictures/font.h"
#include "tools/pictures/viewer_dialogs.h"

namespace bullet_fem
{
namespace
{

constexpr float kTextHeight = 17, kMargin = 14, kWidth = 330;  // [pixels]
constexpr float kFrameSeconds = 1.f / 60;  // constant time step of ImGui: scripts must not depend on the clock
constexpr ImWchar kLetters[] = {0x20, 0xff, 0x370, 0x3ff, 0};  // Latin-1 and Greek

void setStyle()
{
    ImGui::StyleColorsLight();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 8;
    style.FrameRounding = style.GrabRounding = 4;
    style.WindowBorderSize = 0;
    style.WindowPadding = {14, 12};
    style.Colors[ImGuiCol_WindowBg] = {1, 1, 1, 0.86f};
    style.Colors[ImGuiCol_FrameBg] = {0.90f, 0.92f, 0.95f, 1};
    style.Colors[ImGuiCol_Button] = {0.85f, 0.89f, 0.95f, 1};
    style.Colors[ImGuiCol_SliderGrab] = {0.36f, 0.52f, 0.76f, 1};
    style.Colors[ImGuiCol_PlotLines] = {0.20f, 0.40f, 0.70f, 1};
}

int index(MouseButton button)
{
    return button == MouseButton::left ? 0 : button == MouseButton::right ? 1 : 2;
}

void showButtons(ViewerControl& control)
{
    if (ImGui::Button(control.paused() ? "Run" : "Pause", {66, 0})) control.setPaused(!control.paused());
    ImGui::SameLine();
    if (ImGui::Button("Step", {66, 0})) control.requestStep();
    ImGui::SameLine();
    if (ImGui::Button("View", {66, 0})) control.resetView();
    ImGui::SameLine();
    bool wires = control.wireframe();
    if (ImGui::Checkbox("Edges", &wires)) control.setWireframe(wires);
}

void showTimes(const ViewerTimes& times)
{
    const float longest = *std::max_element(times.m_step.begin(), times.m_step.end());
    const float last = times.m_step[(times.m_next + ViewerTimes::kCount - 1) % ViewerTimes::kCount];
    ImGui::Text("A step %.2f ms, a frame %.1f ms", static_cast<double>(last), static_cast<double>(times.m_frame));
    ImGui::PushItemWidth(-1);
    ImGui::PlotLines("##times", times.m_step.data(), ViewerTimes::kCount, times.m_next, nullptr, 0, 1.2f * longest,
                     {0, 56});
    ImGui::PopItemWidth();
    ImGui::Text("longest of the last %d: %.2f ms", ViewerTimes::kCount, static_cast<double>(longest));
}

}  // namespace

void ViewerTimes::add(double stepsMs, int steps, double frameMs)
{
    m_frame = static_cast<float>(frameMs);
    if (steps == 0) return;
    m_step[m_next] = static_cast<float>(stepsMs / steps);
    m_next = (m_next + 1) % kCount;
}

ViewerPanel::ViewerPanel()
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // no settings are stored between runs
    ImFontConfig font;
    font.FontDataOwnedByAtlas = false;
    io.Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(embeddedFont()), embeddedFontSize(), kTextHeight, &font,
                                   kLetters);
    setStyle();
    if (!ImGui_ImplOpenGL3_Init("#version 330")) throw std::runtime_error("viewer: Dear ImGui cannot use OpenGL here");
}

ViewerPanel::~ViewerPanel()
{
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
}

bool ViewerPanel::handle(const ViewerEvent& event)
{
    ImGuiIO& io = ImGui::GetIO();
    switch (event.m_kind)
    {
        case ViewerEvent::Kind::move:
            io.MousePos = {static_cast<float>(event.m_mouse.m_x), static_cast<float>(event.m_mouse.m_y)};
            return false;  // the control needs the mouse position
        case ViewerEvent::Kind::press:
            io.MouseDown[index(event.m_button)] = true;
            return io.WantCaptureMouse || isOverPanel(io.MousePos.x, io.MousePos.y);
        case ViewerEvent::Kind::release:
            io.MouseDown[index(event.m_button)] = false;
            return false;  // the control ends only actions that it began
        case ViewerEvent::Kind::scroll:
            io.MouseWheel += static_cast<float>(event.m_scroll);
            return io.WantCaptureMouse || isOverPanel(io.MousePos.x, io.MousePos.y);
        case ViewerEvent::Kind::key:
        case ViewerEvent::Kind::drop:
            return false;
    }
    return false;
}

bool ViewerPanel::isOverPanel(double x, double y) const
{
    return x >= m_area.m_x && x < m_area.m_x + m_area.m_width && y >= m_area.m_y && y < m_area.m_y + m_area.m_height;
}

void ViewerPanel::showSliders(ViewerSimulation& simulation)
{
    const std::vector<ViewerParameter> parameters = simulation.parameters();
    m_sliders.assign(parameters.size(), {});
    ImGui::PushItemWidth(-1);
    for (std::size_t i = 0; i < parameters.size(); ++i)
    {
        const ViewerParameter& p = parameters[i];
        double value = p.m_value;
        const std::string format = "%.4g" + (p.m_unit.empty() ? "" : " " + p.m_unit);
        const ImGuiSliderFlags flags =
            ImGuiSliderFlags_AlwaysClamp | (p.m_logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
        ImGui::PushID(static_cast<int>(i));
        ImGui::TextUnformatted(p.m_name.c_str());
        if (ImGui::SliderScalar("##value", ImGuiDataType_Double, &value, &p.m_low, &p.m_high, format.c_str(), flags) &&
            value != p.m_value)
            try
            {
                m_message.clear();
                simulation.setParameter(i, value);
            }
            catch (const std::exception& refused)
            {
                m_message = refused.what();
            }
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        m_sliders[i] = {low.x, low.y, high.x - low.x, high.y - low.y};
        ImGui::PopID();
    }
    ImGui::PopItemWidth();
}

void ViewerPanel::showPanel(ViewerSimulation& simulation, ViewerControl& control, const ViewerTimes& times)
{
    ImGui::SetNextWindowPos({kMargin, kMargin});
    ImGui::SetNextWindowSize({kWidth, 0});
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings);
    showButtons(control);
    showSliders(simulation);
    ImGui::Separator();
    showTimes(times);
    const std::string status = simulation.status();
    ImGui::PushTextWrapPos(0);
    if (!status.empty()) ImGui::TextUnformatted(status.c_str());
    const std::string warnings = simulation.warnings();
    if (!warnings.empty()) ImGui::TextColored({0.60f, 0.34f, 0.0f, 1}, "%s", warnings.c_str());
    for (const std::string& words : {m_message, m_fault})
        if (!words.empty()) ImGui::TextColored({0.75f, 0.1f, 0.1f, 1}, "%s", words.c_str());
    ImGui::PopTextWrapPos();
    if (ImGui::Button("Keys (F1)")) control.setHelpShown(!control.helpShown());
    m_area = {kMargin, kMargin, kWidth, static_cast<double>(ImGui::GetWindowHeight())};
    ImGui::End();
}

void ViewerPanel::showDialogs(ViewerSimulation& simulation, ViewerControl& control, const PictureSize& size) const
{
    bool cancelled = false;
    const double height = showProgress(simulation.progress(), size, cancelled);
    if (cancelled) control.handle(ViewerEvent::key(ViewerKey::cancel), size);
    showSentences({simulation.message(), m_film}, size, height);
    if (control.filming()) showFilming(size);
    showHelp(control, size);
}

void ViewerPanel::update(ViewerSimulation& simulation, ViewerControl& control, const ViewerTimes& times,
                         const PictureSize& size)
{
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(size.m_width), static_cast<float>(size.m_height)};
    io.DeltaTime = kFrameSeconds;
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    m_sliders.clear();
    m_area = {};
    if (control.panelShown()) showPanel(simulation, control, times);
    showDialogs(simulation, control, size);
    ImGui::Render();
}

void ViewerPanel::draw() const
{
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace bullet_fem
