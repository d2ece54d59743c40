// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "benchmarks/factor/factor_rows.h"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "benchmarks/factor/lower_matrix.h"
#include "benchmarks/figures.h"
#include "bullet_fem/fem/step/stepping.h"
#include "fem/common/aligned_array.h"
#include "fem/factor/numeric_factor.h"
#include "fem/factor/ordering_libraries.h"
#include "fem/factor/packed_factor.h"
#ifdef BULLETFEM_WITH_CHOLMOD
#include "benchmarks/factor/cholmod_factor.h"
#endif

namespace bullet_fem
{
namespace
{

constexpr int kSides = kPanelLanes;  // right-hand sides solved together

std::vector<double> rightSides(int size, int count)
{
    std::vector<double> b(static_cast<std::size_t>(size) * count);
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = std::sin(0.7 * static_cast<double>(i)) + 0.1;
    return b;
}

/// |b - A x| / |b|.
double residual(const LowerMatrix& A, const std::vector<double>& x, const std::vector<double>& b)
{
    std::vector<double> r(b.begin(), b.begin() + A.m_size);
    for (int c = 0; c < A.m_size; ++c)
        for (int k = A.m_columnStart[c]; k < A.m_columnStart[c + 1]; ++k)
        {
            r[A.m_row[k]] -= A.m_value[k] * x[c];
            if (A.m_row[k] != c) r[c] -= A.m_value[k] * x[A.m_row[k]];
        }
    double sum = 0, size = 0;
    for (int i = 0; i < A.m_size; ++i) sum += r[i] * r[i], size += b[i] * b[i];
    return std::sqrt(sum / size);
}

/// One library that factors one matrix.
class Contender
{
public:
    virtual ~Contender() = default;
    virtual void order() = 0;
    virtual void factorize() = 0;
    virtual void solve(int sides) = 0;
    /// Fills in the error of the last solve's first solution and the figures of the factor.
    virtual void report(FactorRow& row) = 0;
};

class Ours : public Contender
{
public:
    explicit Ours(const FactorSystem& system) : m_system(system) {}

    void order() override
    {
        m_order = fillReducingOrder(m_system.m_pattern);
        m_tree = buildSupernodeTree(m_system.m_pattern, m_order.m_rows);
        m_nodes.clear();
        for (int row : m_order.m_rows) m_nodes.push_back(m_system.m_freeNodes[row]);
    }

    void factorize() override
    {
        m_factor = PackedFactor(m_tree);
        factorSupernodes(m_system.m_A0, m_nodes, m_tree,
                         [this](int s, const double* S, const double* M) { m_factor.pack(s, S, M); });
    }

    void solve(int sides) override
    {
        if (!m_y) makeVectors();
        std::copy_n(m_b.get(), sides == 1 ? m_factor.size() : m_factor.size() * kSides, m_y.get());
        if (sides == 1)
            m_factor.solve(m_y.get(), m_scratch.get());
        else
            m_factor.solveLanes(m_factor.allSupernodes(), m_factor.allSupernodes(), m_y.get(), m_scratch.get());
    }

    void report(FactorRow& row) override
    {
        solve(1);
        const std::vector<double> x(m_y.get(), m_y.get() + m_factor.size()), b(m_b.get(), m_b.get() + m_factor.size());
        row.m_error = residual(lowerMatrix(m_system.m_A0, m_nodes), x, b);
        row.m_ordering = m_order.m_method;
        row.m_fill = static_cast<double>(m_tree.m_entries) / m_system.m_lowerEntries;
        row.m_megabytes = 1e-6 * static_cast<double>(m_factor.byteCount());
    }

private:
    void makeVectors()
    {
        const std::size_t size = std::max(m_factor.vectorSize(), static_cast<std::size_t>(m_factor.size()) * kSides);
        m_y = allocateFloats(size);
        m_b = allocateFloats(size);
        m_scratch = allocateFloats(std::max(m_factor.scratchSize(), m_factor.laneScratchSize()));
        const std::vector<double> b = rightSides(m_factor.size(), kSides);
        std::copy(b.begin(), b.end(), m_b.get());
    }

    const FactorSystem& m_system;
    FillOrder m_order;
    SupernodeTree m_tree;
    std::vector<int> m_nodes;
    PackedFactor m_factor;
    AlignedFloats m_y, m_b, m_scratch;
};

#ifdef BULLETFEM_WITH_CHOLMOD
class Cholmod : public Contender
{
public:
    Cholmod(const FactorSystem& system, LowerMatrix A, CholmodFactor::Kind kind, CholmodFactor::Order order)
        : m_lowerEntries(system.m_lowerEntries), m_A(std::move(A)), m_kind(kind), m_order(order)
    {
    }

    void order() override { m_factor = std::make_unique<CholmodFactor>(m_A, m_kind, m_order); }
    void factorize() override { m_factor->factorize(); }
    void solve(int sides) override
    {
        std::vector<double>& b = sides == 1 ? m_one : m_all;
        if (b.empty()) b = rightSides(m_A.m_size, sides);
        m_x = m_factor->solve(b, sides);
    }

    void report(FactorRow& row) override
    {
        solve(1);
        row.m_error = residual(m_A, m_x, m_one);
        row.m_fill = m_factor->entries() / m_lowerEntries;
        row.m_megabytes = 1e-6 * static_cast<double>(m_factor->bytes());
    }

private:
    const double m_lowerEntries;
    const LowerMatrix m_A;
    const CholmodFactor::Kind m_kind;
    const CholmodFactor::Order m_order;
    std::unique_ptr<CholmodFactor> m_factor;
    std::vector<double> m_one, m_all, m_x;
};
#endif

class EigenLlt : public Contender
{
public:
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

    EigenLlt(const FactorSystem& system, LowerMatrix A)
        : m_lowerEntries(system.m_lowerEntries),
          m_A(std::move(A)),
          m_matrix(m_A.m_size, m_A.m_size, static_cast<Eigen::Index>(m_A.m_row.size()), m_A.m_columnStart.data(),
                   m_A.m_row.data(), m_A.m_value.data()),
          m_b(Eigen::MatrixXd::Map(rightSides(m_A.m_size, kSides).data(), m_A.m_size, kSides))
    {
    }

    void order() override { m_llt.analyzePattern(m_matrix); }
    void factorize() override { m_llt.factorize(m_matrix); }
    void solve(int sides) override { m_x = m_llt.solve(m_b.leftCols(sides)); }

    void report(FactorRow& row) override
    {
        solve(1);
        row.m_error =
            residual(m_A, std::vector<double>(m_x.data(), m_x.data() + m_A.m_size), rightSides(m_A.m_size, 1));
        row.m_ordering = "Eigen";
        const double entries = static_cast<double>(m_llt.matrixL().nestedExpression().nonZeros());
        row.m_fill = entries / m_lowerEntries;
        row.m_megabytes = 1e-6 * entries * (sizeof(double) + sizeof(int));
    }

private:
    const double m_lowerEntries;
    const LowerMatrix m_A;
    const Eigen::Map<const Matrix> m_matrix;
    const Eigen::MatrixXd m_b;
    Eigen::SimplicialLLT<Matrix> m_llt;
    Eigen::MatrixXd m_x;
};

struct NamedContender
{
    const char* m_name;
    std::unique_ptr<Contender> m_contender;
};

std::vector<NamedContender> contendersFor(const FactorSystem& system)
{
    std::vector<NamedContender> contenders;
    contenders.push_back({"BulletFEM", std::make_unique<Ours>(system)});
    const LowerMatrix A = lowerMatrix(system.m_A0, system.m_freeNodes);
#ifdef BULLETFEM_WITH_CHOLMOD
    using Kind = CholmodFactor::Kind;
    using Order = CholmodFactor::Order;
    std::vector<int> ours = fillReducingOrder(system.m_pattern).m_rows;
    buildSupernodeTree(system.m_pattern, ours);
    for (int& row : ours) row = system.m_freeNodes[row];
    contenders.push_back({"CHOLMOD supernodal", std::make_unique<Cholmod>(system, A, Kind::supernodal, Order::own)});
    contenders.push_back({"same, our order", std::make_unique<Cholmod>(system, lowerMatrix(system.m_A0, ours),
                                                                       Kind::supernodal, Order::natural)});
    contenders.push_back({"CHOLMOD simplicial", std::make_unique<Cholmod>(system, A, Kind::simplicial, Order::own)});
#endif
    contenders.push_back({"Eigen SimplicialLLT", std::make_unique<EigenLlt>(system, A)});
    return contenders;
}

using Stage = std::function<void(Contender&)>;

/// The median time of a stage for each contender; contenders run in turns.
std::vector<double> medians(const std::vector<NamedContender>& contenders, const Stage& stage, double seconds)
{
    std::vector<TimedWork> work;
    for (const NamedContender& c : contenders)
        work.push_back({c.m_name, [&stage, &c] { stage(*c.m_contender); }, nullptr});
    std::vector<double> result;
    for (const Timing& time : timeInTurns(work, seconds)) result.push_back(time.m_median);
    return result;
}

std::string dashIfNone(double value)
{
    char text[24] = "-";
    if (value > 0) std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

}  // namespace

std::vector<FactorRow> measureFactors(const FactorCase& factorCase, double seconds)
{
    const FactorSystem system(factorCase);
    const std::vector<NamedContender> contenders = contendersFor(system);
    const auto order = medians(
        contenders, [](Contender& c) { c.order(); }, seconds);
    const auto numeric = medians(
        contenders, [](Contender& c) { c.factorize(); }, seconds);
    const auto one = medians(
        contenders, [](Contender& c) { c.solve(1); }, seconds);
    const auto sixteen = medians(
        contenders, [](Contender& c) { c.solve(kSides); }, seconds);
    std::vector<FactorRow> rows;
    for (std::size_t k = 0; k < contenders.size(); ++k)
    {
        FactorRow row;
        row.m_case = factorCase.m_name;
        row.m_method = contenders[k].m_name;
        row.m_tets = factorCase.m_shape->m_mesh.tetCount();
        row.m_orderSeconds = order[k];
        row.m_numericSeconds = numeric[k];
        row.m_solveSeconds = one[k];
        row.m_sixteenSeconds = sixteen[k];
        contenders[k].m_contender->report(row);
        rows.push_back(row);
    }
    return rows;
}

FirstStepRow measureFirstStep(const FactorCase& factorCase, int repetitions)
{
    const TetMesh& given = factorCase.m_shape->m_mesh;
    std::vector<double> mesh, model, step;
    for (int k = 0; k < repetitions; ++k)
    {
        Stopwatch watch;
        const auto shape = std::make_shared<const RestShape>(TetMesh(given.restPositions(), given.tets()),
                                                             factorCase.m_shape->m_material);
        mesh.push_back(watch.seconds());
        watch = Stopwatch();
        const auto made = BodyModel::create(shape, factorCase.m_input);
        model.push_back(watch.seconds());
        watch = Stopwatch();
        Body body(made);
        for (std::size_t i = 0; i < body.m_loads.m_force.size(); ++i)
            body.m_loads.m_force[i] = body.m_state.m_mass[i] * Vec3{0, 0, -9.81};
        bullet_fem::step(body, StepSettings());
        step.push_back(watch.seconds());
    }
    return {factorCase.m_name, given.tetCount(), median(mesh), median(model), median(step)};
}

FillRow measureFill(const FactorCase& factorCase)
{
    const FactorSystem system(factorCase);
    const auto fill = [&system](const std::vector<int>& order)
    {
        if (order.empty()) return 0.0;
        const double blocks = static_cast<double>(blocksOfFactor(system.m_pattern, order));
        return (9 * blocks - 3 * system.m_pattern.m_size) / system.m_lowerEntries;
    };
    FillRow row;
    row.m_case = factorCase.m_name;
    row.m_tets = factorCase.m_shape->m_mesh.tetCount();
    row.m_freeNodes = system.m_pattern.m_size;
    row.m_amd = fill(amdOrder(system.m_pattern));
    row.m_metis = fill(metisOrder(system.m_pattern));
    row.m_eigen = fill(eigenOrder(system.m_pattern));
    row.m_chosen = fillReducingOrder(system.m_pattern).m_method;
    return row;
}

void printTable(std::ostream& out, const std::vector<FactorRow>& rows)
{
    print(out, "%-12s %-20s %-6s %9s %11s %10s %12s %6s %9s %9s\n", "matrix", "factor", "order", "order ms",
          "numeric ms", "solve ms", "16 solves ms", "fill", "MB", "residual");
    for (const FactorRow& row : rows)
        print(out, "%-12s %-20s %-6s %9.2f %11.2f %10.3f %12.3f %6.1f %9.2f %9.0e\n", row.m_case.c_str(),
              row.m_method.c_str(), row.m_ordering.c_str(), 1e3 * row.m_orderSeconds, 1e3 * row.m_numericSeconds,
              1e3 * row.m_solveSeconds, 1e3 * row.m_sixteenSeconds, row.m_fill, row.m_megabytes, row.m_error);
}

void printTable(std::ostream& out, const std::vector<FirstStepRow>& rows)
{
    print(out, "%-12s %8s %9s %14s %9s\n", "set-up", "mesh ms", "factor ms", "first step ms", "all ms");
    for (const FirstStepRow& row : rows)
        print(out, "%-12s %8.1f %9.1f %14.2f %9.1f\n", row.m_case.c_str(), 1e3 * row.m_mesh, 1e3 * row.m_model,
              1e3 * row.m_step, 1e3 * (row.m_mesh + row.m_model + row.m_step));
}

void printTable(std::ostream& out, const std::vector<FillRow>& rows)
{
    print(out, "%-28s %7s %7s  %7s %7s %7s  %s\n", "mesh", "tets", "nodes", "AMD", "METIS", "Eigen", "chosen");
    for (const FillRow& row : rows)
        print(out, "%-28s %7d %7d  %7s %7s %7s  %s\n", row.m_case.c_str(), row.m_tets, row.m_freeNodes,
              dashIfNone(row.m_amd).c_str(), dashIfNone(row.m_metis).c_str(), dashIfNone(row.m_eigen).c_str(),
              row.m_chosen.c_str());
}

nlohmann::json toJson(const std::vector<FactorRow>& rows)
{
    nlohmann::json result = nlohmann::json::array();
    for (const FactorRow& row : rows)
        result.push_back({{"matrix", row.m_case},
                          {"tets", row.m_tets},
                          {"factor", row.m_method},
                          {"ordering", row.m_ordering},
                          {"order_ms", 1e3 * row.m_orderSeconds},
                          {"numeric_ms", 1e3 * row.m_numericSeconds},
                          {"solve_ms", 1e3 * row.m_solveSeconds},
                          {"sixteen_ms", 1e3 * row.m_sixteenSeconds},
                          {"fill", row.m_fill},
                          {"factor_mb", row.m_megabytes},
                          {"residual", row.m_error}});
    return result;
}

nlohmann::json toJson(const std::vector<FirstStepRow>& rows)
{
    nlohmann::json result = nlohmann::json::array();
    for (const FirstStepRow& row : rows)
        result.push_back({{"matrix", row.m_case},
                          {"tets", row.m_tets},
                          {"mesh_ms", 1e3 * row.m_mesh},
                          {"model_ms", 1e3 * row.m_model},
                          {"step_ms", 1e3 * row.m_step}});
    return result;
}

nlohmann::json toJson(const std::vector<FillRow>& rows)
{
    nlohmann::json result = nlohmann::json::array();
    for (const FillRow& row : rows)
        result.push_back({{"mesh", row.m_case},
                          {"tets", row.m_tets},
                          {"free_nodes", row.m_freeNodes},
                          {"amd", row.m_amd},
                          {"metis", row.m_metis},
                          {"eigen", row.m_eigen},
                          {"chosen", row.m_chosen}});
    return result;
}

std::string factorLibraries()
{
#ifdef BULLETFEM_WITH_CHOLMOD
    return orderingBackend() + "; " + cholmodVersion();
#else
    return orderingBackend();
#endif
}

}  // namespace bullet_fem
