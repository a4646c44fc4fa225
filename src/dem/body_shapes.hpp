// The bodies' shapes as items of the pair search (the paper's merge), and their wrenches (its separate).
#pragma once

#include <span>
#include <vector>

#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/body_exchange.hpp"
#include "model/model.hpp"
#include "model/touching.hpp"

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
  const TouchRule& rule() const { return rule_; }

 private:
  std::vector<ShapeItem> items_;
  TouchRule rule_;
};

}  // namespace scree
