// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/btFemFlagText.h"
#include "python/core/handles.h"

namespace bullet_fem::python
{
namespace
{

/// Names of the flags that are set, such as "inside out", each with its explanation.
py::dict flagsOf(const btFemStepReport& report)
{
    py::dict flags;
    for (int bit = 0; bit < 31; ++bit)
    {
        const int flag = 1 << bit;
        if ((report.m_flags & flag) == 0) continue;
        if (const btFemFlagText* text = btFemFlagText::find(flag)) flags[text->m_title] = text->m_explanation;
    }
    return flags;
}

}  // namespace

void bindReports(py::module_& module)
{
    using Report = btFemStepReport;
    py::class_<Report>(module, "StepReport", py::module_local(), "How a soft body's last step went.")
        .def_property_readonly("flags", &flagsOf, "Conditions that hold, a dict of titles and explanations.")
        .def_property_readonly(
            "message", [](const Report& self) { return std::string(self.m_message ? self.m_message : ""); },
            "Reason of a rejection, or empty.")
        .def_readonly("iterations", &Report::m_iterations, "Iterations of the free motion.")
        .def_readonly("residual", &Report::m_residual, "Relative residual of the free motion [-].")
        .def_readonly("contacts", &Report::m_contacts, "Number of contact points.")
        .def_readonly("deepest_penetration", &Report::m_deepestPenetration, "At the start of the step [m].")
        .def_readonly("impact_stress", &Report::m_impactStress,
                      "Stress of the wave that the hardest impact of the step starts [Pa]; 0 without impact.")
        .def_readonly("factor_megabytes", &Report::m_factorMegabytes, "Memory of the factor [MB].")
        .def_readonly("factor_seconds", &Report::m_factorSeconds, "Wall time of the factorization [s].")
        .def_readonly("free_motion_ms", &Report::m_freeMotionMs, "Wall time of the free motion [ms].")
        .def_readonly("contact_ms", &Report::m_contactMs, "Wall time of contacts of the body's group [ms].");
}

}  // namespace bullet_fem::python
