// Work dissipated at the triangles of meshes since t = 0: by the normal damping, by friction, and the worn
// volume. Sums in fixed point: they have the same bits for any order of the contacts, any distribution over
// ranks, and after a restart. Shared by the CPU and CUDA backends, except for the last part.
#pragma once

#include <cstdint>
#include <vector>

#include "base/fixed_sum.hpp"
#include "base/hd.hpp"
#include "dem/surface_contact/friction_surfaces.hpp"
#include "dem/surface_contact/surface_items.hpp"
#include "partition/ranks.hpp"

namespace scree {

enum TriangleWorkKind {
  kImpactWork,   // [J]
  kSlidingWork,  // [J]
  kWornVolume,   // [m^3 / kWornScale]
  kTriangleWorks
};
// Scale of the worn volumes, which are small: a power of two that brings them into the range of the sums.
inline constexpr Real kWornScale = Real(std::uint64_t{1} << 40);

// Sums of one triangle.
struct TriangleWork {
  FixedSum of[kTriangleWorks];
};

// Layout of the sums and wear parameters, on the machine that accumulates them.
struct TriangleWorkTable {
  const std::int64_t* first;  // per placed surface that is a mesh: number of its first triangle
  const Real* wear;           // [i * materials + j]: volume per work of friction [1/Pa]; null: no wear
  int materials;
};

// Dissipation of one contact over a step [J].
struct ContactWorks {
  Real impact, sliding;
};

// lost: with the losses by kind as parts.
SCREE_HD ContactWorks by_sliding(Real lost, const TangentialLosses& losses) {
  return {lost - losses.sum(), losses.of[kFrictionLoss]};
}

// Dissipation of the contacts with surfaces from the last evaluation, by type of step; the particles' energy
// accounting uses the same numbers.
struct ExplicitWorks {
  const SurfaceLoad* loads;
  Real h;      // [s]
  bool moves;  // the law distinguishes losses by kind, over whole steps

  SCREE_HD bool touches(Index entry) const { return loads[entry].touches; }
  SCREE_HD ContactWorks of(Index entry) const {
    const SurfaceLoad& contact = loads[entry];
    const Real lost = h * contact.load.loss;
    if (!moves) return {lost, 0};
    return by_sliding(lost, contact.losses());
  }
};
struct ImplicitWorks {
  const SurfaceStep* steps;

  SCREE_HD bool touches(Index entry) const { return steps[entry].touches; }
  SCREE_HD ContactWorks of(Index entry) const { return {steps[entry].contact.losses.dissipated, 0}; }
};
struct ImplicitFrictionWorks {
  const SurfaceFriction* friction_steps;

  SCREE_HD bool touches(Index entry) const { return friction_steps[entry].touches; }
  SCREE_HD ContactWorks of(Index entry) const {
    const FrictionLosses& losses = friction_steps[entry].contact.losses;
    return by_sliding(losses.dissipated, losses.by_kind);
  }
};

// Accumulates the dissipation of the contacts of the g-th group over a closed step. Add: adds an integer to a
// limb, possibly concurrently.
template <class Works, class Add>
struct TriangleWorkItem {
  SurfaceViews in;
  TriangleWorkTable table;
  Works works;
  TriangleWork* sums;

  SCREE_HD void operator()(Index g) const {
    const MeshGroup group = in.meshes.groups[g];
    for (Index entry = group.entry; entry < group.entry + group.entries; ++entry) {
      if (!works.touches(entry)) continue;
      const Index surface = in.surface_of(entry);
      TriangleWork& sum = sums[table.first[surface] + in.touches[entry].triangle];
      const ContactWorks lost = works.of(entry);
      add(sum.of[kImpactWork], lost.impact), add(sum.of[kSlidingWork], lost.sliding);
      if (table.wear == nullptr) continue;
      const int one = in.material[in.entries.particles[entry]], other = in.placed[surface].material;
      add(sum.of[kWornVolume], kWornScale * (table.wear[one * table.materials + other] * lost.sliding));
    }
  }

 private:
  SCREE_HD static void add(FixedSum& sum, Real term) {
    FixedSum::for_each_piece(term, [&sum](int word, std::int64_t piece) { Add::add(sum.word[word], piece); });
  }
};

// Number of terms added to the sums since they were normalized.
class TermCount {
 public:
  // Counts more terms; returns false if the sums must be normalized first.
  bool take(std::int64_t more) {
    terms_ += more;
    if (terms_ <= FixedSum::kMostTerms) return true;
    terms_ = more;
    return false;
  }

 private:
  std::int64_t terms_ = 0;
};
struct NormalizeItem {
  TriangleWork* sums;
  SCREE_HD void operator()(Index triangle) const {
    for (FixedSum& sum : sums[triangle].of) sum.normalize();
  }
};

// Triangles of a model and the conversion of their sums to and from a state; on the host.
class TriangleWorks {
 public:
  // Empty for a model whose output needs no works.
  explicit TriangleWorks(const Model& model);
  bool exist() const { return triangles_ > 0; }
  std::size_t triangles() const { return triangles_; }
  const std::vector<std::int64_t>& first() const { return first_; }
  const std::vector<Real>& wear() const { return wear_; }
  int materials() const { return materials_; }

  // Limbs of a state, [triangles][kTriangleWorks][FixedSum::kNumbers], with triangles in the order of their
  // files or shapes and meshes in the order of SurfaceSet; and the sums in the order of accumulation. Without
  // limbs the sums are zero.
  std::vector<std::int64_t> limbs(const std::vector<TriangleWork>& sums) const;
  std::vector<TriangleWork> sums(const std::vector<std::int64_t>& limbs) const;

 private:
  // Calls visit(row in the limbs, row in the sums) for all triangles.
  template <class Visit>
  void for_each_row(const Visit& visit) const;

  std::vector<std::int64_t> first_;
  std::vector<const SurfaceMesh*> meshes_;  // per placed surface; null if not a mesh
  std::vector<Real> wear_;                  // empty: no wear
  int materials_ = 0;
  std::size_t triangles_ = 0;
};

// Number of limbs per triangle in a state.
inline constexpr std::size_t kLimbsPerTriangle = std::size_t{kTriangleWorks} * FixedSum::kNumbers;
// Sum of the limbs of all ranks. Collective.
std::vector<std::int64_t> all_works(std::vector<std::int64_t> limbs, const Ranks& ranks);
// Adds the limbs of other contacts at the same triangles.
void add_works(const std::vector<std::int64_t>& more, std::vector<std::int64_t>& limbs);
// Values of the sums, each rounded once.
struct TriangleWorkValues {
  Real impact, sliding;  // [J]
  Real worn;             // [m^3]
};
std::vector<TriangleWorkValues> work_values(const std::vector<std::int64_t>& limbs);

}  // namespace scree
