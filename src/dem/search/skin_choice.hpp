// The skin of neighbour lists where the deck names none.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "base/types.hpp"
#include "model/data/model.hpp"

namespace scree {

// Costs of a backend, over the cost of walking rows without skin in one step. They are measured once: no
// clock takes part in the choice, so that a rerun builds the same lists.
struct ListCosts {
  Real fixed;       // of a list, whatever its skin
  Real search;      // of a list, times the volume that it searches
  Real walked = 1;  // share of the skin that the rows of most steps reach; below 1 where rows are pruned
};

// Chooses the skin with which lists and steps together take the least time. It follows from collective
// counters alone, so that all ranks choose the same. No bit depends on the skin in double precision;
// elsewhere the skin is that of the deck or its default.
class SkinChoice {
 public:
  SkinChoice(const Model& model, const ListCosts& costs);

  // Of the next list [m].
  Real next() const { return next_; }
  // Whether there is anything to choose.
  bool is_open() const { return unit_ > 0; }
  // A list has ended: in `steps` steps, particles have moved by at most `moved` [m].
  void note(Real moved, std::int64_t steps);
  // Skin whose list of `entries` now, on this rank, needs at most the free memory in addition [B]; [m].
  Real limit_in_memory(Real free, Real entries, Real bytes_per_entry) const;
  // Skins beyond `limit` [m], which is the same on all ranks, are not chosen any more.
  void limit_to(Real limit) { limit_ = std::min(limit_, limit); }

 private:
  Real cost(Real skin, Real step) const;

  ListCosts costs_;
  Real unit_ = 0;  // the smallest radius; 0: nothing is chosen [m]
  Real limit_, next_;
  int dimension_;
};

// Whether results depend neither on the instants at which lists are built nor on their extent. Implicit steps
// build few lists and keep the fixed rules.
bool lists_leave_no_trace(const Model& model);
// Whether the program chooses the skin.
bool chooses_skin(const Model& model);
// The smallest and the largest skin that may be chosen [m].
std::pair<Real, Real> skins_to_choose_from(const Model& model);
// Largest skin that a periodic domain has room for [m].
Real widest_skin_of_domain(const Model& model);

}  // namespace scree
