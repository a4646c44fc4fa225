// The particles' linear solve against Gaussian elimination of the same matrix.
#include <cmath>
#include <numeric>
#include <utility>

#include "dem/cpu/cpu_solver.hpp"
#include "model/derived/random.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 2 * kUlp;  // of two products

constexpr Index kParticles = 12;
constexpr Real kInverseScale = 1 / 0.7;  // 1 / (1 + hht_alpha)

// Ghosts on one rank: particle i has the ghost kParticles + i, across a periodic side.
Halo one_ghost_each() {
  Space space;
  space.dimension = 2, space.max = {1, 1, 0};
  space.boundary[kXMin] = space.boundary[kXMax] = Boundary::periodic;
  const std::vector<Vec4> position(kParticles, Vec4{0.1, 0.5, 0, 0.1});
  Halo halo;
  halo.exchange(Ranks(), {}, Subdomain(space), position, 0.2);
  REQUIRE(halo.size() == kParticles);
  return halo;
}

// A random contact graph in the solver's sparse form and as a dense matrix of 3 x 3 blocks.
struct ContactProblem {
  ContactProblem(Real stiffness, bool ghosts) : dense(9 * kParticles * kParticles) {
    RandomNumbers random(static_cast<std::uint64_t>(stiffness) + ghosts);
    std::vector<std::vector<std::pair<Index, Vec3>>> rows(kParticles);
    for (Index i = 0; i < kParticles; ++i) {
      velocity.push_back({0, 0, 0, random.uniform(0.5, 2)});
      const Real mass = velocity.back().w * kInverseScale;
      add(i, i, {mass, 0, 0, mass, 0, mass}, 1);
    }
    diagonal.resize(kParticles);
    for (Index i = 0; i < kParticles; ++i)
      for (Index j = 0; j < i; ++j)
        if (random.uniform() < 0.4)
          add_pair(i, j, std::sqrt(stiffness) * vector(random), ghosts && j % 2 == 0, rows);
    for (Index i = 0; i < kParticles; i += 3)
      add_to_diagonal(i, std::sqrt(stiffness) * vector(random));  // walls
    flatten(rows);
    for (Index i = 0; i < kParticles; ++i) {
      Sym3 block = diagonal[static_cast<std::size_t>(i)];
      const Real mass = velocity[static_cast<std::size_t>(i)].w * kInverseScale;
      // The sum of a symmetric matrix's entries bounds its norm.
      const Real bound = block.xx + block.yy + block.zz;
      largest_stiffness_ratio = std::max(largest_stiffness_ratio, bound / mass);
      block += Sym3{mass, 0, 0, mass, 0, mass};
      inverse_block.push_back(inverse(block));
      right_hand_side.push_back(vector(random));
    }
  }

  static Vec3 vector(RandomNumbers& random) {
    const Real x = random.normal(), y = random.normal(), z = random.normal();
    return {x, y, z};
  }
  void add(Index i, Index j, Sym3 block, Real sign) {
    const Real entries[9] = {block.xx, block.xy, block.xz, block.xy, block.yy,
                             block.yz, block.xz, block.yz, block.zz};
    for (int k = 0; k < 9; ++k) dense[entry(3 * i + k / 3, 3 * j + k % 3)] += sign * entries[k];
  }
  static std::size_t entry(Index row, Index column) {
    return static_cast<std::size_t>(row * 3 * kParticles + column);
  }
  void add_to_diagonal(Index i, Vec3 b) {
    diagonal[static_cast<std::size_t>(i)] += outer(1, b);
    add(i, i, outer(1, b), 1);
  }
  // volatile: otherwise the compiler keeps digits that a single does not have.
  static Real single(Real x) {
    volatile float rounded = static_cast<float>(x);
    return rounded;
  }
  // through_ghosts: each particle has the other one as a ghost across a periodic side.
  void add_pair(Index i, Index j, Vec3 exact, bool through_ghosts,
                std::vector<std::vector<std::pair<Index, Vec3>>>& rows) {
    const Vec3 b{single(exact.x), single(exact.y), single(exact.z)};  // as the solver stores it
    add_to_diagonal(i, b), add_to_diagonal(j, b);
    add(i, j, outer(1, b), -1), add(j, i, outer(1, b), -1);
    for (const auto& [row, partner, sign] : {std::tuple{i, j, 1.0}, std::tuple{j, i, -1.0}}) {
      const Index seen = through_ghosts ? kParticles + partner : partner;
      rows[static_cast<std::size_t>(row)].emplace_back(seen, sign * b);
    }
  }
  // Rows with an unused slot at their end, as in a neighbour list whose pairs do not all touch.
  void flatten(const std::vector<std::vector<std::pair<Index, Vec3>>>& rows) {
    for (const auto& row : rows) {
      offsets.push_back(static_cast<Index>(entries.size())), count.push_back(static_cast<Index>(row.size()));
      for (const auto& [j, vector] : row) entries.push_back(contact_entry(vector, j));
      entries.push_back({1e30f, 1e30f, 1e30f, 0});
    }
    offsets.push_back(static_cast<Index>(entries.size()));
  }

  // Gaussian elimination with pivoting.
  std::vector<Real> gauss() const {
    std::vector<Real> a = dense, x;
    for (const Vec3& v : right_hand_side) x.insert(x.end(), {v.x, v.y, v.z});
    const Index n = 3 * kParticles;
    const auto at = [&](Index i, Index j) -> Real& { return a[entry(i, j)]; };
    const auto value = [&](Index i) -> Real& { return x[static_cast<std::size_t>(i)]; };
    for (Index k = 0; k < n; ++k) {
      Index pivot = k;
      for (Index i = k; i < n; ++i) pivot = std::abs(at(i, k)) > std::abs(at(pivot, k)) ? i : pivot;
      for (Index j = 0; j < n; ++j) std::swap(at(k, j), at(pivot, j));
      std::swap(value(k), value(pivot));
      for (Index i = k + 1; i < n; ++i) {
        const Real factor = at(i, k) / at(k, k);
        for (Index j = k; j < n; ++j) at(i, j) -= factor * at(k, j);
        value(i) -= factor * value(k);
      }
    }
    for (Index k = n - 1; k >= 0; --k) {
      for (Index j = k + 1; j < n; ++j) value(k) -= at(k, j) * value(j);
      value(k) /= at(k, k);
    }
    return x;
  }

  std::vector<Real> dense;
  std::vector<Vec4> velocity;
  std::vector<Sym3> diagonal, inverse_block;
  std::vector<Index> offsets, count;
  std::vector<ContactEntry> entries;
  std::vector<Vec3> right_hand_side;
  Real largest_stiffness_ratio = 0;
};

// The system of `solve_on_host`.
struct System {
  ContactProblem& problem;
  std::vector<Vec3>&residual, &solution;
  std::vector<Vec4> directions[2];

  DirectionItem direction_item(const ChebyshevWeights& weights) const {
    return {problem.inverse_block.data(), residual.data(), weights.from_last, weights.from_residual};
  }
  std::vector<Vec4>& direction(int product) { return directions[product % 2]; }
  auto first(const ChebyshevWeights& weights) {
    return FirstDirectionItem{direction_item(weights), direction(0).data(), solution.data()};
  }
  auto product(int product, const ChebyshevWeights& weights) {
    const SubtractMatrixItem<PackedRows> subtract{
        {problem.count.data(), problem.entries.data(), problem.diagonal.data()},
        {problem.offsets.data(), nullptr},
        problem.velocity.data(),
        kInverseScale,
        direction(product).data(),
        residual.data()};
    return ProductItem{subtract, direction_item(weights), direction(product + 1).data(), solution.data()};
  }
};

}  // namespace

TEST_CASE("the solve goes a tenth below the Newton tolerance, and no further than two digits") {
  CHECK(near(solver_tolerance(1e-6, 50, 1e-4), 5e-6, {.relative = kRoundOff}));  // a tenth of 1e-6 x 50 N
  CHECK(near(solver_tolerance(1e-6, 50, 3), 0.03, {.relative = kRoundOff}));     // a hundredth of 3 N
}

TEST_CASE("the matrix-free solve finds the solution of the dense one") {
  for (const Real stiffness : {0.0, 1.0, 10.0, 100.0})
    for (const bool ghosts : {false, true}) {
      CAPTURE(stiffness, ghosts);
      ContactProblem p(stiffness, ghosts);
      std::vector<Vec3> residual = p.right_hand_side, solution(kParticles);
      const Halo halo = one_ghost_each();
      std::vector<Vec4> d(kParticles + static_cast<std::size_t>(halo.size()));
      const Real tolerance = 1e-11;
      System system{p, residual, solution, {d, d}};
      const int products =
          solve_on_host(halo, Ranks(), kParticles, system, p.largest_stiffness_ratio, tolerance);
      const std::vector<Real> expected = p.gauss();
      // The smallest eigenvalue is at least the lightest particle's mass.
      const Real truncation = tolerance * std::sqrt(kParticles) / 0.5;
      for (std::size_t i = 0; i < kParticles; ++i) {
        CHECK(norm(residual[i]) <= tolerance);
        const Vec3 x{expected[3 * i], expected[3 * i + 1], expected[3 * i + 2]};
        CHECK(norm(solution[i] - x) <= truncation);
      }
      // Chebyshev's bound: the error falls by (sqrt(c) - 1) / (sqrt(c) + 1) per product, c <= 2 (1 +
      // stiffness ratio).
      CHECK(products <= 5 + 20 * std::sqrt(2 * (1 + p.largest_stiffness_ratio)));
    }
}

}  // namespace scree
