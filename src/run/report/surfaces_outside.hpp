// Surfaces that reach beyond the open sides of the space: particles that leave there are searched no longer,
// so that what a bucket carries out of the space falls through it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dem/reports/leaver_items.hpp"
#include "model/data/body_exchange.hpp"
#include "model/data/model.hpp"

namespace scree {

// A warning of the bodies whose shapes and meshes reach beyond an open side at t = 0, and of the walls of
// triangles that do until the end of the run, where walls move looked at in some hundred instants. Empty
// without any, without particles, and where a particle that leaves is an error.
std::string outside_at_start(const Model& model);

// Where particles take leave of surfaces that could hold them.
class SurfacesOutside {
 public:
  explicit SurfacesOutside(const Model& model);
  // A warning of the first of the leavers that is among the surfaces of a body, or of a wall, that reaches
  // beyond an open side: in the box around them, or less than a particle's diameter from it. Empty if there
  // is none. motion: of the bodies, then of the placed walls, at the time t [s].
  std::string warning(std::span<const Leaver> leavers, std::span<const BodyMotion> motion, Real t) const;

 private:
  const Model& model_;
  std::vector<std::optional<Box>> boxes_;  // of each carrier in its own frame; none of carriers of planes
  std::vector<std::string> names_;
};

}  // namespace scree
