// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/scene/mesh_loading.h"

#include <stdexcept>
#include <utility>

#include "fem/common/reason.h"
#include "io/text/file_bytes.h"
#include "tools/scene/mesh_input.h"

namespace bullet_fem
{
namespace
{

constexpr double kRead = 0.05, kCaged = 0.6;  // completed fraction after each stage

}  // namespace

MeshLoading::MeshLoading(MeshRequest request) : m_request(std::move(request)), m_thread([this] { run(); }) {}

MeshLoading::~MeshLoading()
{
    cancel();
    m_thread.join();
}

void MeshLoading::run()
{
    try
    {
        m_body = make();
        if (m_cancelled) throw CageCancelled();
        m_share = 1;
    }
    catch (...)
    {
        m_error = std::current_exception();
    }
    m_finished = true;
}

BakedBody MeshLoading::make()
{
    if (lowerCaseEnding(m_request.m_path) == ".bfem") return readBakedBody(m_request.m_path, BakedLoading::copied);
    CageSettings cage = m_request.m_cage;
    cage.m_progress = [this](double share)
    {
        m_stage = "making the cage";
        m_share = kRead + (kCaged - kRead) * share;
        return !m_cancelled;
    };
    const MeshInput input = MeshInput::read(m_request.m_path, m_request.m_scale, cage);
    if (m_cancelled) throw CageCancelled();
    m_share = kCaged;
    m_stage = "factoring";
    BakeSettings bake = m_request.m_bake;
    if (!bake.m_regionMaterials.empty()) bake.m_labels = input.m_labels;
    try
    {
        if (!bake.m_regionMaterials.empty() && bake.m_labels.empty())
            throw std::runtime_error("it has no regions and is not painted; give it one material");
        return input.m_cage ? bakeBody(*input.m_cage, input.m_surface, bake) : bakeBody(input.m_mesh, bake);
    }
    catch (const std::exception& error)
    {
        throw std::runtime_error("'" + m_request.m_path + "': " + reasonOf(error));
    }
}

BakedBody MeshLoading::take()
{
    if (m_error) std::rethrow_exception(std::exchange(m_error, nullptr));
    return std::move(m_body);
}

}  // namespace bullet_fem
