// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The only file that knows CHOLMOD. It calls the LGPL modules Core, Check, Cholesky and Partition for an order,
// never Supernodal; the factor is our own.
#include <cholmod.h>

#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <stdexcept>
#include <string>

#include "fem/factor/fill_order.h"

namespace bullet_fem
{
namespace
{

struct Session
{
    cholmod_common m_common;

    Session()
    {
        cholmod_start(&m_common);
        m_common.supernodal = CHOLMOD_SIMPLICIAL;
        m_common.print = 0;
        m_common.error_handler = nullptr;
    }
    ~Session() { cholmod_finish(&m_common); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    void check(const char* what) const
    {
        switch (m_common.status)
        {
            case CHOLMOD_OK:
                return;
            case CHOLMOD_OUT_OF_MEMORY:
                throw std::bad_alloc();
            case CHOLMOD_TOO_LARGE:
                throw std::runtime_error(std::string(what) +
                                         ": the factor has more entries than CHOLMOD's int can count; "
                                         "use a coarser mesh");
            case CHOLMOD_INVALID:
                throw std::runtime_error(std::string(what) + ": CHOLMOD found its input invalid");
            default:
                throw std::runtime_error(std::string(what) + ": CHOLMOD failed with status " +
                                         std::to_string(m_common.status));
        }
    }
};

// CHOLMOD's view of our pattern; nothing is copied and CHOLMOD does not write to it.
cholmod_sparse view(const SparsePattern& A)
{
    cholmod_sparse view = {};
    view.nrow = view.ncol = static_cast<std::size_t>(A.m_size);
    view.nzmax = A.m_rowIndex.size();
    view.p = const_cast<int*>(A.m_columnStart.data());
    view.i = const_cast<int*>(A.m_rowIndex.data());
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_PATTERN;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = view.packed = 1;
    return view;
}

auto owned(cholmod_factor* factor, Session& session)
{
    const auto release = [&session](cholmod_factor* f) { cholmod_free_factor(&f, &session.m_common); };
    return std::unique_ptr<cholmod_factor, decltype(release)>(factor, release);
}

}  // namespace

const char* orderingBackend()
{
    static const std::string name = "CHOLMOD " + std::to_string(CHOLMOD_MAIN_VERSION) + "." +
                                    std::to_string(CHOLMOD_SUB_VERSION) + "." + std::to_string(CHOLMOD_SUBSUB_VERSION);
    return name.c_str();
}

std::vector<int> fillReducingOrder(const SparsePattern& pattern, const char*& methodName)
{
    // METIS seeds the C library's one random generator and draws from it: in turn, or orders would differ.
    static std::mutex generator;
    const std::lock_guard<std::mutex> turn(generator);
    Session session;
    session.m_common.nmethods = 2;
    session.m_common.method[0].ordering = CHOLMOD_METIS;
    session.m_common.method[1].ordering = CHOLMOD_AMD;
    session.m_common.postorder = 1;
    cholmod_sparse A = view(pattern);
    const auto factor = owned(cholmod_analyze(&A, &session.m_common), session);
    session.check("fill-reducing order");
    if (!factor) throw std::runtime_error("fill-reducing order: CHOLMOD returned nothing");
    methodName = factor->ordering == CHOLMOD_METIS ? "METIS" : factor->ordering == CHOLMOD_AMD ? "AMD" : "natural";
    const int* perm = static_cast<const int*>(factor->Perm);
    return std::vector<int>(perm, perm + pattern.m_size);
}

}  // namespace bullet_fem
