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

/// A file that shall become a body.
struct MeshRequest
{
    std::string m_path;   ///< of tetrahedra, a surface or a baked body
    double m_scale = 1;   ///< times the file's positions [-], > 0; baked bodies keep theirs
    CageSettings m_cage;  ///< of a surface; its progress is not used
    /// Material, step and memory; m_labels are the file's where there are materials of regions.
    BakeSettings m_bake;
};

/// Reads a file, makes a cage around it if it is a surface, and factors, in a thread of its own. Calls come from one
/// thread.
class MeshLoading
{
public:
    explicit MeshLoading(MeshRequest request);
    /// Gives up, and waits until the thread has noticed: a factor that has begun is finished.
    ~MeshLoading();
    MeshLoading(const MeshLoading&) = delete;
    MeshLoading& operator=(const MeshLoading&) = delete;

    const MeshRequest& request() const { return m_request; }
    /// Of the work that is done [-], in [0, 1]; it never falls.
    double share() const { return m_share; }
    /// What is done now, in one word or two.
    const char* stage() const { return m_stage; }
    bool finished() const { return m_finished; }
    void cancel() { m_cancelled = true; }
    /// What became of it, once, when it is finished. Throws std::runtime_error, or std::invalid_argument, that names
    /// the file; CageCancelled if it was given up.
    BakedBody take();

private:
    void run();
    BakedBody make();

    const MeshRequest m_request;
    std::atomic<double> m_share{0};
    std::atomic<const char*> m_stage{"reading"};
    std::atomic<bool> m_cancelled{false}, m_finished{false};
    BakedBody m_body;  // both by the thread until m_finished
    std::exception_ptr m_error;
    std::thread m_thread;
};

}  // namespace bullet_fem
