// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "bullet_fem/fem/contact/elastic_rebound.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

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

// Limits for several patches: largest ratio of half periods that steps resolve, sweeps over the patches of a step, and
// the change of an impulse as a share of the largest that ends them [-].
constexpr int kMaxRatio = 4, kPatchSweeps = 50;
constexpr double kPatchError = 1e-6;

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

// Patches of bodies that meet, in steps of implicit Euler.
class PatchImpacts
{
public:
    PatchImpacts(const MeetingPatches& patches, double step)
        : m_patches(patches), m_count(patches.m_responses.size()), m_step(step)
    {
        for (std::size_t p = 0; p < m_count; ++p)
        {
            Patch& patch = m_state[p];
            patch.m_closing = patches.m_speed[p];
            const PatchResponse& response = patches.m_responses[p];
            for (int k = 0; k < response.m_count; ++k)
            {
                const PatchResponse::Vibration& of = response.m_vibrations[k];
                patch.m_share[k] = 1 / (1 + step * of.m_frequency * (of.m_damping + step));
                patch.m_mobility += of.m_mobility * patch.m_share[k];
            }
        }
    }

    // Steps on; returns the number of patches that press.
    int advance()
    {
        for (std::size_t p = 0; p < m_count; ++p) predict(p);
        solve();
        int pressed = 0;
        for (std::size_t p = 0; p < m_count; ++p)
        {
            Patch& patch = m_state[p];
            for (std::size_t q = 0; q < m_count; ++q) patch.m_closing -= compliance(p, q) * m_state[q].m_impulse;
            patch.m_approach += m_step * patch.m_closing;
            const PatchResponse& response = m_patches.m_responses[p];
            for (int k = 0; k < response.m_count; ++k)
            {
                patch.m_v[k] += patch.m_share[k] * response.m_vibrations[k].m_mobility * patch.m_impulse;
                patch.m_z[k] += m_step * patch.m_v[k];
            }
            if (patch.m_impulse > 0) ++pressed;
        }
        return pressed;
    }

    double closing(std::size_t p) const { return m_state[p].m_closing; }

private:
    struct Patch
    {
        double m_closing = 0;   // approach speed of the rigid motions [m/s]
        double m_approach = 0;  // of the rigid motions since they met [m]
        double m_mobility = 0;  // of the vibrations within a step [1/kg]
        double m_overlap = 0;   // without an impulse, over the step [m/s]
        double m_impulse = 0;   // [N s]
        std::array<double, 2 *kVibrations> m_share = {}, m_z = {}, m_v = {};
    };

    double compliance(std::size_t p, std::size_t q) const { return m_patches.m_compliance[p * m_count + q]; }

    void predict(std::size_t p)
    {
        Patch& patch = m_state[p];
        const PatchResponse& response = m_patches.m_responses[p];
        patch.m_closing += m_step * m_patches.m_acceleration[p];
        double overlap = patch.m_approach + m_step * patch.m_closing;
        for (int k = 0; k < response.m_count; ++k)
        {
            patch.m_v[k] =
                patch.m_share[k] * (patch.m_v[k] - m_step * response.m_vibrations[k].m_frequency * patch.m_z[k]);
            overlap -= patch.m_z[k] + m_step * patch.m_v[k];
        }
        patch.m_overlap = overlap / m_step;
    }

    // Projected Gauss-Seidel from the impulses of the last step.
    void solve()
    {
        for (int sweep = 0; sweep < kPatchSweeps; ++sweep)
        {
            double change = 0, most = 0;
            for (std::size_t p = 0; p < m_count; ++p)
            {
                const double mobility = compliance(p, p) + m_state[p].m_mobility;
                double overlap = m_state[p].m_overlap;
                for (std::size_t q = 0; q < m_count; ++q)
                    if (q != p) overlap -= compliance(p, q) * m_state[q].m_impulse;
                const double impulse = std::max(overlap / mobility, 0.0);
                change = std::max(change, std::abs(impulse - m_state[p].m_impulse));
                most = std::max(most, impulse);
                m_state[p].m_impulse = impulse;
            }
            if (m_count == 1 || !(change > kPatchError * most)) return;
        }
    }

    const MeetingPatches& m_patches;
    const std::size_t m_count;
    const double m_step;  // [s]
    std::array<Patch, MeetingPatches::kMaxCount> m_state;
};

// Half a period of a patch's contact; 0: it has none [s].
double halfPeriodOf(const MeetingPatches& patches, std::size_t p)
{
    constexpr double kPi = 3.14159265358979323846;
    const PatchResponse& response = patches.m_responses[p];
    double softness = 0;
    for (int k = 0; k < response.m_count; ++k)
        softness += response.m_vibrations[k].m_mobility / response.m_vibrations[k].m_frequency;
    const double rigid = patches.m_compliance[p * patches.m_responses.size() + p];
    return softness > 0 && rigid > 0 ? kPi * std::sqrt(softness / rigid) : 0;
}

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

bool findPartingSpeeds(const MeetingPatches& patches, std::vector<double>& parting)
{
    const std::size_t count = patches.m_responses.size();
    if (count > MeetingPatches::kMaxCount || patches.m_compliance.size() != count * count ||
        patches.m_speed.size() != count || patches.m_acceleration.size() != count)
        throw std::invalid_argument("findPartingSpeeds: " + std::to_string(count) + " patches, which must be at most " +
                                    std::to_string(MeetingPatches::kMaxCount) +
                                    " and have a speed, an acceleration and a row of the compliance each");
    double shortest = 0, longest = 0;
    for (std::size_t p = 0; p < count; ++p)
    {
        const double half = halfPeriodOf(patches, p);
        if (!(half > 0)) return false;
        shortest = p == 0 ? half : std::min(shortest, half);
        longest = std::max(longest, half);
    }
    const double step = std::max(shortest, longest / kMaxRatio) / kSteps;
    const int half = static_cast<int>(std::ceil(longest / step));
    PatchImpacts impacts(patches, step);
    int before = 0, open = 0;
    bool isParted = false;
    // Waves pass from patch to patch in half a period.
    const int last = (count > 1 ? kParted + static_cast<int>(count) : kLongest) * half;
    for (int k = 0; k < last && open <= kParted * half; ++k)
    {
        const int pressed = impacts.advance();
        if (pressed < before || (count == 1 && pressed > 0))
        {
            isParted = true;
            parting.resize(count);
            for (std::size_t p = 0; p < count; ++p) parting[p] = -impacts.closing(p);
        }
        before = pressed;
        open = pressed > 0 ? 0 : open + 1;
    }
    return isParted && (count > 1 || open > kParted * half);
}

}  // namespace bullet_fem
