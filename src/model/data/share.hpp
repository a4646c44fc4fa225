// How the ranks that build one model divide the particles among them, and agree on what concerns all. This is
// one rank alone; partition/shared_model.hpp has many. All functions but rank() and size() are collective.
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
  std::int64_t number = 0;  // a particle's global id; shapes count on
  int material = 0;
  bool is_own = true;  // of this rank, and of no other one
};

class Share {
 public:
  virtual ~Share() = default;
  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  // This rank's part of `count` particles.
  IdRange part(std::int64_t count) const { return id_range(count, rank(), size()); }

  // Runs an action; what it throws on one rank, all throw.
  virtual void together(const std::function<void()>& action) const { action(); }
  virtual std::int64_t sum(std::int64_t value) const { return value; }
  virtual std::int64_t min(std::int64_t value) const { return value; }
  // Largest of values >= 0.
  virtual Real max(Real value) const { return value; }
  // Of the ranks on this rank's host.
  virtual Real sum_on_host(Real value) const { return value; }
  // The items of all ranks, on every rank.
  virtual std::vector<StartItem> everywhere(std::vector<StartItem> own) const { return own; }
  // Deals the items out, some of them to several ranks, so that any two that come within `reach` [m] of each
  // other, across periodic sides included, meet on the ranks that own them then.
  virtual std::vector<StartItem> near_each_other(std::vector<StartItem> own, const Space&,
                                                 Real /*reach*/) const {
    return own;
  }
};

}  // namespace scree
