// The contacts of particles and of bodies' shapes as snapshots show them: columns of lines.
#pragma once

#include <string>
#include <vector>

#include "dem/backend/reports.hpp"
#include "model/data/model.hpp"
#include "output/snapshot.hpp"
#include "partition/ranks.hpp"

namespace scree {

// What is touched at the end of a line, as files have it.
enum class ContactKind : int { particle, wall, body };

// This rank's part of the lines of all ranks: those of bodies' shapes, which are rank 0's, then those of
// particles in the order of the first particles' ids.
class ContactNetwork {
 public:
  ContactNetwork() = default;
  // lines: of this rank's particles, of which all ranks have `particles` ids. Collective.
  ContactNetwork(const Model& model, const Ranks& ranks, ContactLines lines);
  // Views of it.
  LineSnapshot snapshot() const;
  // Those of snapshot(), for the model.
  static std::vector<std::string> field_names(const Model& model);

 private:
  void add(const ContactLine& line, const SurfaceSet& surfaces);

  bool rubs_ = false;
  std::vector<Vec3> ends_, force_;
  std::vector<Real> normal_force_, tangential_force_, overlap_, slip_;
  std::vector<GlobalId> first_, second_;
  std::vector<int> kind_, wall_, body_, first_body_;
};

}  // namespace scree
