// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/contact/elastic_rebound.h"

#include <algorithm>
#include <cmath>

#include "fem/body/step_scratch.h"
#include "fem/factor/rest_factor.h"
#include "fem/solve/warped_system.h"

namespace bullet_fem
{
namespace
{

constexpr int kVibrations = PatchResponse::kVibrations;

// A Lanczos vector shorter than this share of the largest eigenvalue is rounding of the factor's single precision [-].
constexpr double kExhausted = 1e-5;

// Enough of Jacobi's sweeps for eigenvalues to double precision: they converge quadratically [-].
constexpr int kJacobiSweeps = 12;

// The simulated impact: steps in half a period of the contact, of which implicit Euler takes 1 % of the speed; half
// periods after which bodies still in contact rest on each other; half periods without contact until they have parted.
constexpr int kSteps = 400, kLongest = 20, kParted = 2;

// A symmetric tridiagonal matrix.
struct Tridiagonal
{
    int m_count = 0;
    std::array<double, kVibrations> m_diagonal = {}, m_next = {};
};

// Its eigenvalues, and the squares of the first entries of its eigenvectors.
struct Quadrature
{
    std::array<double, kVibrations> m_value = {}, m_weight = {};
};

// By Jacobi's rotations.
Quadrature quadratureOf(const Tridiagonal& T)
{
    double A[kVibrations][kVibrations] = {}, first[kVibrations] = {1};
    const int n = T.m_count;
    for (int i = 0; i < n; ++i)
    {
        A[i][i] = T.m_diagonal[i];
        if (i + 1 < n) A[i][i + 1] = A[i + 1][i] = T.m_next[i];
    }
    const auto rotate = [&](int p, int q)
    {
        const double angle = 0.5 * std::atan2(2 * A[p][q], A[q][q] - A[p][p]);
        const double c = std::cos(angle), s = std::sin(angle);
        const auto turn = [c, s](double& a, double& b)
        {
            const double old = a;
            a = c * old - s * b;
            b = s * old + c * b;
        };
        for (int k = 0; k < n; ++k) turn(A[k][p], A[k][q]);
        for (int k = 0; k < n; ++k) turn(A[p][k], A[q][k]);
        turn(first[p], first[q]);
    };
    for (int sweep = 0; sweep < kJacobiSweeps; ++sweep)
        for (int p = 0; p < n; ++p)
            for (int q = p + 1; q < n; ++q)
                if (A[p][q] != 0) rotate(p, q);
    Quadrature result;
    for (int i = 0; i < n; ++i)
    {
        result.m_value[i] = A[i][i];
        result.m_weight[i] = first[i] * first[i];
    }
    return result;
}

double massDot(const std::vector<double>& mass, const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += mass[i] * dot(a[i], b[i]);
    return sum;
}

void scaleBy(double factor, std::vector<Vec3>& v)
{
    for (Vec3& u : v) u *= factor;
}

// Lanczos' method on P M from q, a vector of length one in the norm of M, which is overwritten.
Tridiagonal lanczos(Body& body, std::vector<Vec3>& q)
{
    StepScratch& scratch = body.m_workspace.scratch();
    std::vector<Vec3>&before = scratch.m_solver.m_z, &load = scratch.m_rightSide, &next = scratch.m_increment;
    const std::vector<double>& mass = body.m_state.m_mass;
    const WarpedPreconditioner P(body);
    Tridiagonal T;
    std::fill(before.begin(), before.end(), Vec3());
    double link = 0;
    while (T.m_count < kVibrations)
    {
        for (std::size_t i = 0; i < q.size(); ++i) load[i] = mass[i] * q[i];
        P.apply(load, next);
        const double own = dot(next, load);
        if (!(own > 0)) break;
        T.m_diagonal[T.m_count++] = own;
        for (std::size_t i = 0; i < q.size(); ++i) next[i] -= own * q[i] + link * before[i];
        link = std::sqrt(massDot(mass, next, next));
        if (!(link > kExhausted * T.m_diagonal[0])) break;
        T.m_next[T.m_count - 1] = link;
        before.swap(q);
        q.swap(next);
        scaleBy(1 / link, q);
    }
    return T;
}

// The patch of two bodies that meet, in steps of implicit Euler.
class PatchImpact
{
public:
    PatchImpact(const PatchResponse& response, double step) : m_response(response), m_step(step)
    {
        m_mobility = response.m_rigid;
        for (int k = 0; k < response.m_count; ++k)
        {
            const PatchResponse::Vibration& of = response.m_vibrations[k];
            m_share[k] = 1 / (1 + step * of.m_frequency * (of.m_damping + step));
            m_mobility += of.m_mobility * m_share[k];
        }
    }

    // Steps on; returns whether the two press each other.
    bool advance(double acceleration)
    {
        m_closing += m_step * acceleration;
        double overlap = m_approach + m_step * m_closing;
        for (int k = 0; k < m_response.m_count; ++k)
        {
            m_v[k] = m_share[k] * (m_v[k] - m_step * m_response.m_vibrations[k].m_frequency * m_z[k]);
            overlap -= m_z[k] + m_step * m_v[k];
        }
        const double impulse = std::max(overlap / (m_step * m_mobility), 0.0);
        m_closing -= m_response.m_rigid * impulse;
        m_approach += m_step * m_closing;
        for (int k = 0; k < m_response.m_count; ++k)
        {
            m_v[k] += m_share[k] * m_response.m_vibrations[k].m_mobility * impulse;
            m_z[k] += m_step * m_v[k];
        }
        return impulse > 0;
    }

    double m_closing = 0;  // approach speed of the rigid motions [m/s]

private:
    const PatchResponse& m_response;
    const double m_step;    // [s]
    double m_mobility = 0;  // within a step [1/kg]
    double m_approach = 0;  // of the rigid motions since they met [m]
    std::array<double, 2 *kVibrations> m_share = {}, m_z = {}, m_v = {};
};

}  // namespace

// Lanczos' method from M^-1 f gives a Gauss quadrature of f^T M^-1/2 g(K) M^-1/2 f: P is the warped (s M + a K)^-1, an
// eigenvalue of P M is 1 / (s + a w^2).
bool addVibrations(Body& body, const std::vector<Vec3>& impulses, PatchResponse& response)
{
    const BodyModel& model = *body.m_model;
    if (model.factorReport().m_path != FactorPath::full) return false;
    StepScratch& scratch = body.m_workspace.scratch();
    const std::vector<double>& mass = body.m_state.m_mass;
    const double h = model.factorInput().m_step, beta = model.shape().m_material.m_stiffnessDamping;
    std::vector<Vec3>&q = scratch.m_solver.m_p, &load = scratch.m_rightSide;
    for (std::size_t i = 0; i < q.size(); ++i) load[i] = body.m_state.m_fixed[i] ? Vec3() : impulses[i];
    scratch.m_momentum.removeImpulses(body, load);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = (1 / mass[i]) * load[i];
    const double all = massDot(mass, q, q);
    if (!(all > 0)) return true;
    scaleBy(1 / std::sqrt(all), q);
    const Tridiagonal T = lanczos(body, q);
    const Quadrature found = quadratureOf(T);
    for (int k = 0; k < T.m_count; ++k)
    {
        const double frequency = (1 / found.m_value[k] - massScale(model)) / (h * (h + beta));
        if (found.m_value[k] > 0 && frequency > 0)
            response.m_vibrations[response.m_count++] = {all * found.m_weight[k], frequency, beta};
    }
    return true;
}

double rigidMobility(Body& body, const std::vector<Vec3>& impulses)
{
    StepScratch& scratch = body.m_workspace.scratch();
    std::vector<Vec3>& change = scratch.m_increment;
    std::fill(change.begin(), change.end(), Vec3());
    scratch.m_momentum.addResponse(body, impulses, change);
    double sum = 0;
    for (std::size_t i = 0; i < impulses.size(); ++i) sum += dot(impulses[i], change[i]);
    return sum;
}

double elasticRestitution(const PatchResponse& response, double speed, double acceleration)
{
    double softness = 0;
    for (int k = 0; k < response.m_count; ++k)
        softness += response.m_vibrations[k].m_mobility / response.m_vibrations[k].m_frequency;
    if (!(softness > 0) || !(response.m_rigid > 0)) return 0;
    constexpr double kPi = 3.14159265358979323846;
    PatchImpact impact(response, kPi * std::sqrt(softness / response.m_rigid) / kSteps);
    impact.m_closing = speed;
    double parting = 0;
    for (int step = 0, open = 0; step < kLongest * kSteps && open <= kParted * kSteps; ++step)
    {
        open = impact.advance(acceleration) ? 0 : open + 1;
        if (open == 0) parting = -impact.m_closing;
        if (open > kParted * kSteps) return std::min(std::max(parting / speed, 0.0), 1.0);
    }
    return 0;
}

}  // namespace bullet_fem
