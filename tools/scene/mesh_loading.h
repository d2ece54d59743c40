// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <atomic>
#include <exception>
#include <string>
#include <thread>

#include "bullet_fem/fem/baked/baked_body.h"

namespace bullet_fem
{

/// A file to be loaded as a body.
struct MeshRequest
{
    std::string m_path;   ///< file of tetrahedra, a surface or a baked body
    double m_scale = 1;   ///< factor on the file's positions [-], > 0; ignored for baked bodies
    CageSettings m_cage;  ///< for a surface; its progress callback is not used
    /// Material, step and memory; m_labels are taken from the file if regions have materials.
    BakeSettings m_bake;
};

/// Reads a file, makes a cage around it if it is a surface, and factors, in a thread of its own. All calls must come
/// from one thread.
class MeshLoading
{
public:
    explicit MeshLoading(MeshRequest request);
    /// Cancels the work and waits for the thread; a factorization that has begun is completed.
    ~MeshLoading();
    MeshLoading(const MeshLoading&) = delete;
    MeshLoading& operator=(const MeshLoading&) = delete;

    const MeshRequest& request() const { return m_request; }
    /// Completed fraction of the work [-], in [0, 1]; never decreases.
    double share() const { return m_share; }
    /// Name of the present stage.
    const char* stage() const { return m_stage; }
    bool finished() const { return m_finished; }
    void cancel() { m_cancelled = true; }
    /// Returns the body, once, after the work has finished. Throws std::runtime_error or std::invalid_argument with the
    /// file name; CageCancelled after a cancellation.
    BakedBody take();

private:
    void run();
    BakedBody make();

    const MeshRequest m_request;
    std::atomic<double> m_share{0};
    std::atomic<const char*> m_stage{"reading"};
    std::atomic<bool> m_cancelled{false}, m_finished{false};
    BakedBody m_body;  // written by the thread until m_finished
    std::exception_ptr m_error;
    std::thread m_thread;
};

}  // namespace bullet_fem
