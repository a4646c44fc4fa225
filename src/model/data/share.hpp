// Distribution of the particles over the ranks that build a model, and their joint decisions. This class is
// for a single rank; partition/shared_model.hpp has the one for many. All functions but rank() and size() are
// collective.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/data/id_range.hpp"

namespace scree {

struct Space;

// A particle or a shape of a body at t = 0.
struct StartItem {
  Vec3 position;            // [m]
  Real radius = 0;          // [m]
  std::int64_t number = 0;  // a particle's global id; shapes have the numbers after them
  int material = 0;
  bool is_own = true;  // owned by this rank; every item has one owner
};

class Share {
 public:
  virtual ~Share() = default;
  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  // This rank's range of `count` particles.
  IdRange part(std::int64_t count) const { return id_range(count, rank(), size()); }

  // Runs an action; an exception on one rank is thrown on all ranks.
  virtual void collectively(const std::function<void()>& action) const { action(); }
  virtual std::int64_t sum(std::int64_t value) const { return value; }
  virtual std::int64_t min(std::int64_t value) const { return value; }
  // Largest of values >= 0.
  virtual Real max(Real value) const { return value; }
  // Sum over the ranks on this rank's host.
  virtual Real sum_on_host(Real value) const { return value; }
  // The items of all ranks, on every rank.
  virtual std::vector<StartItem> all_gather(std::vector<StartItem> own) const { return own; }
  // Distributes the items, some of them to several ranks, so that any two within `reach` [m] of each other,
  // also across periodic sides, are on a rank that owns one of them.
  virtual std::vector<StartItem> distribute_by_boxes(std::vector<StartItem> own, const Space&,
                                                     Real /*reach*/) const {
    return own;
  }
};

}  // namespace scree
