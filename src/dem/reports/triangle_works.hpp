// What contacts have lost at the triangles of meshes since t = 0: to the damping of their normal forces, to
// friction, and what of the surface that wears off. Sums at fixed places: the same bits in any order of the
// contacts, for any split over ranks and after any restart. One text for the CPU and CUDA, but for the last
// part.
#pragma once

#include <cstdint>
#include <vector>

#include "base/fixed_sum.hpp"
#include "base/hd.hpp"
#include "dem/surface_contact/rubbing_surfaces.hpp"
#include "dem/surface_contact/surface_items.hpp"
#include "partition/ranks.hpp"

namespace scree {

enum TriangleWorkKind {
  kImpactWork,   // [J]
  kSlidingWork,  // [J]
  kWornVolume,   // [m^3 / kWornScale]
  kTriangleWorks
};
// Volumes are small numbers: a power of two brings them to where sums have places for them.
inline constexpr Real kWornScale = Real(std::uint64_t{1} << 40);

// Of one triangle.
struct TriangleWork {
  FixedSum of[kTriangleWorks];
};

// Where they stand, and what wears; on the machine that books them.
struct TriangleWorkTable {
  const std::int64_t* first;  // per placed surface that is a mesh: its first triangle among those of all
  const Real* wear;           // [i * materials + j]: volume per work of friction [1/Pa]; null: nothing wears
  int materials;
};

// Of one contact, over a step [J].
struct ContactWorks {
  Real impact, sliding;
};

// Of the contacts with surfaces as they were found last, by the form of the step. The particles' own books
// are made of the same numbers.
struct ExplicitWorks {
  const SurfaceLoad* loads;
  Real h;      // [s]
  bool moves;  // the law tells losses by kind: it books whole steps

  SCREE_HD bool touches(Index entry) const { return loads[entry].touches; }
  SCREE_HD ContactWorks of(Index entry) const {
    const SurfaceLoad& contact = loads[entry];
    const Real lost = h * contact.load.loss;
    if (!moves) return {lost, 0};
    const RubbingLosses& rubbed = contact.losses;
    return {lost - (rubbed.of[kFrictionLoss] + rubbed.of[kRollingLoss] + rubbed.of[kTwistingLoss]),
            rubbed.of[kFrictionLoss]};
  }
};
struct ImplicitWorks {
  const SurfaceStep* steps;

  SCREE_HD bool touches(Index entry) const { return steps[entry].touches; }
  SCREE_HD ContactWorks of(Index entry) const { return {steps[entry].books.dissipated, 0}; }
};
struct ImplicitRubbingWorks {
  const SurfaceRub* rubs;

  SCREE_HD bool touches(Index entry) const { return rubs[entry].touches; }
  SCREE_HD ContactWorks of(Index entry) const {
    const RubbingBooks& books = rubs[entry].books;
    return {books.dissipated - books.friction, books.friction};
  }
};

// Books what the contacts of the g-th group have lost over a step that is closed. Add: adds a whole number to
// a word, which others may add to, too.
template <class Works, class Add>
struct TriangleBookItem {
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

// How many terms sums may have got since they were normalized.
class TermCount {
 public:
  // Counts so many more; false: the sums must be normalized before.
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

// The same on the host: which triangles there are, and their sums as a state keeps them.
class TriangleWorks {
 public:
  // Of a model whose output asks for none all below is empty.
  explicit TriangleWorks(const Model& model);
  bool exist() const { return triangles_ > 0; }
  std::size_t triangles() const { return triangles_; }
  const std::vector<std::int64_t>& first() const { return first_; }
  const std::vector<Real>& wear() const { return wear_; }
  int materials() const { return materials_; }

  // Words of a state, [triangles][kTriangleWorks][FixedSum::kWords], triangles as in their files or shapes,
  // mesh after mesh in the order of SurfaceSet; and the sums in the order in which they are booked. No words:
  // nothing was lost yet.
  std::vector<std::int64_t> words(const std::vector<TriangleWork>& sums) const;
  std::vector<TriangleWork> sums(const std::vector<std::int64_t>& words) const;

 private:
  // Calls visit(row in the words, row in the sums) for all triangles.
  template <class Visit>
  void for_each_row(const Visit& visit) const;

  std::vector<std::int64_t> first_;
  std::vector<const SurfaceMesh*> meshes_;  // per placed surface; null: it is none
  std::vector<Real> wear_;                  // empty: nothing wears
  int materials_ = 0;
  std::size_t triangles_ = 0;
};

// How many words the state of a model has whose output asks for them.
inline constexpr std::size_t kWordsPerTriangle = std::size_t{kTriangleWorks} * FixedSum::kWords;
// The ranks' words added up. Collective.
std::vector<std::int64_t> all_works(std::vector<std::int64_t> words, const Ranks& ranks);
// Adds the words of other contacts at the same triangles.
void add_works(const std::vector<std::int64_t>& more, std::vector<std::int64_t>& words);
// What their sums are, each rounded once.
struct TriangleWorkValues {
  Real impact, sliding;  // [J]
  Real worn;             // [m^3]
};
std::vector<TriangleWorkValues> work_values(const std::vector<std::int64_t>& words);

}  // namespace scree
