// The bodies' shapes as items of the pair search (the paper's merge), and their wrenches (its separate).
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/body_exchange.hpp"
#include "model/model.hpp"

namespace scree {

// One shape of one body; constant.
struct ShapeItem {
  int body;
  Vec3 offset;  // in the body frame [m]
  Real radius;  // [m]
  int material;
  GlobalId global_id;  // counts on after the particles
};

class BodyShapes {
 public:
  explicit BodyShapes(const Model& model);

  const std::vector<ShapeItem>& items() const { return items_; }
  Index size() const { return static_cast<Index>(items_.size()); }
  // Whether shapes of these two bodies may touch: not of one body, nor of two that a joint or a force element
  // connects unless the deck says so.
  bool may_touch(int body_a, int body_b) const;
  // The bodies whose shapes those of this one must not touch, besides its own.
  const std::vector<int>& connected(int body) const { return connected_[static_cast<std::size_t>(body)]; }

 private:
  std::vector<ShapeItem> items_;
  std::vector<std::vector<int>> connected_;  // per body, sorted
};

}  // namespace scree
