// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <vector>

#include "bullet_fem/fem/vec3.h"
#include "fem/contact/response_kernel.h"

namespace bullet_fem
{

/// A dense compliance between some ends of a body: blocks W_ef of 3 x 3, in single precision, columns of e side by
/// side. Grows, never shrinks.
class DenseCompliance
{
public:
    /// Room for this many ends; what was in it is lost.
    void resize(int ends)
    {
        m_order = 3 * static_cast<std::size_t>(ends);
        if (m_values.size() < m_order * m_order) m_values.resize(m_order * m_order);
    }

    /// Keeps resize() to this many ends from allocating.
    void reserve(int ends) { m_values.reserve(9 * static_cast<std::size_t>(ends) * ends); }

    /// Rows and columns, three an end.
    std::size_t order() const { return m_order; }

    /// The velocity of row i for an impulse of one along column j.
    float& operator()(std::size_t i, std::size_t j) { return m_values[j * m_order + i]; }

    /// All rows of column j.
    float* column(std::size_t j) { return &m_values[j * m_order]; }

    /// W_ef: velocity of end e for impulses on f.
    Mat3 block(int e, int f) const
    {
        Mat3 w;
        const float* column = &m_values[3 * f * m_order + 3 * e];
        for (int c = 0; c < 3; ++c, column += m_order)
            for (int i = 0; i < 3; ++i) w(i, c) = column[i];
        return w;
    }

    void setBlock(int e, int f, const Mat3& w)
    {
        float* column = &m_values[3 * f * m_order + 3 * e];
        for (int c = 0; c < 3; ++c, column += m_order)
            for (int i = 0; i < 3; ++i) column[i] = static_cast<float>(w(i, c));
    }

    /// Adds the velocities that an impulse on an end makes, one an end.
    void respond(int e, const Vec3& impulse, std::vector<Vec3>& velocity) const
    {
        addResponse(&m_values[3 * e * m_order], m_order, impulse, &velocity[0].x);
    }

    void scale(double factor)
    {
        for (std::size_t i = 0; i < m_order * m_order; ++i) m_values[i] *= static_cast<float>(factor);
    }

private:
    std::size_t m_order = 0;
    std::vector<float> m_values;
};

}  // namespace bullet_fem
