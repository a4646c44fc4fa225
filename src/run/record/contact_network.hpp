// The contact network in snapshots: contacts of particles and of bodies' shapes as columns of lines.
#pragma once

#include <string>
#include <vector>

#include "dem/backend/reports.hpp"
#include "model/data/model.hpp"
#include "output/snapshot.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Kind of the partner at a line's end, as files store it.
enum class ContactKind : int { particle, wall, body };

// This rank's part of the lines of all ranks: the contacts of bodies' shapes (on rank 0), then those of
// particles, ordered by the id of the first particle.
class ContactNetwork {
 public:
  ContactNetwork() = default;
  // bound: above the ids of all particles; lines: the contacts of this rank's particles. Collective.
  ContactNetwork(const Model& model, const Ranks& ranks, GlobalId bound, ContactLines lines);
  // Views of this object's columns.
  LineSnapshot snapshot() const;
  // The names of the fields that snapshot() has for the model.
  static std::vector<std::string> field_names(const Model& model);

 private:
  void add(const ContactLine& line, const SurfaceSet& surfaces);

  bool friction_steps_ = false;
  std::vector<Vec3> ends_, force_;
  std::vector<Real> normal_force_, tangential_force_, overlap_, slip_;
  std::vector<GlobalId> first_, second_;
  std::vector<int> kind_, wall_, body_, first_body_;
};

}  // namespace scree
