// Contacts of bodies' shapes with each other and with all other surfaces: few, they are all rank 0's, on the
// host, where shapes are what particles are elsewhere.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "dem/history/shape_contacts.hpp"
#include "dem/host/cpu_history.hpp"
#include "dem/host/cpu_surfaces.hpp"
#include "dem/laws/contact_kernels.hpp"
#include "dem/search/neighbor_list.hpp"
#include "dem/surface_contact/body_items.hpp"
#include "dem/surface_contact/body_pairs.hpp"
#include "dem/surfaces/corner_set.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "model/data/model.hpp"
#include "model/derived/touching.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// What touches a body or a wall, and what it does to it.
struct ContactSum {
  Vec3 force;   // [N]
  Vec3 torque;  // about the body's centre or the wall's point [N m]
  std::int64_t contacts = 0;

  ContactSum& operator+=(const ContactSum& other) {
    force += other.force, torque += other.torque, contacts += other.contacts;
    return *this;
  }
};

// From the sums of WallContactItem, indexed by WallTerm.
ContactSum make_wall_contact(const Real* sums);

// Of all contacts of shapes at an instant, or over the explicit step that ended there.
struct BodyContactTotals {
  Real loss_power = 0;      // [W]
  Real elastic_energy = 0;  // [J]
  SpringEnergies springs;   // of that
  RubbingLosses losses{};   // over the step [J]
  Real pairs = 0;           // number
};

// The laws of bodies' contacts: bodies neither attract each other nor are they attracted by walls. Theirs are
// those without attraction, with tension as the dampers of laws with it have.
Contact without_attraction(Contact contact);

class BodyContacts {
 public:
  BodyContacts(const Model& model, const SurfaceSet& surfaces, const Subdomain& subdomain);

  // Before surfaces are brought into the periodic box for another list: keeps by name what contacts remember.
  void leave_list(const SurfacePlaces& places);
  // Finds what can touch before one of the surfaces has moved by half the skin [m]. Other ranks than 0 leave
  // it.
  void build(const SurfacePlaces& places, Real skin);

  // The contacts at an instant (h = 0), over the explicit step of length h that ends now, and over an
  // implicit one, which began at places.start.
  void find_loads(const SurfacePlaces& places, Real h);
  void find_steps(const SurfacePlaces& places, Real h);
  // Of the last find: what surfaces get that are touched, some twice.
  void add_sums(std::vector<InstantSums>& to) const;
  void add_sums(std::vector<StepSums>& to) const;
  std::vector<PairStiffness> pairs() const { return pairs_.blocks(); }  // of find_steps
  BodyContactTotals totals() const;                                     // of find_loads
  BodyStep step_totals() const;                                         // of find_steps; without sums
  std::vector<TriangleSums> triangle_sums() const;                      // of find_loads
  // What shapes do to a wall at rest, where they were at the last find at an instant. wall: index into
  // Model::walls.
  ContactSum on_wall(int wall);
  // Of find_loads at an instant: each contact once.
  std::vector<ContactLine> lines(const SurfacePlaces& places);

  // What was found last at triangles of meshes, over an explicit step of length h and over an implicit one.
  void book_loads(const SurfacePlaces& places, Real h);
  void book_steps(const SurfacePlaces& places);
  std::vector<std::int64_t> works() const { return entries_.works(); }
  void clear_works() { entries_.load_works({}); }

  // The step that was found last, if there is one since, is accepted: contacts remember it; or it is dropped.
  // reopen(): the step that was accepted last will be found anew.
  void accept();
  void drop() { has_step_ = false; }
  void reopen();
  // What contacts remember; what another law has remembered counts for nothing. load: before the first list.
  void load(const ShapeContacts& contacts);
  ShapeContacts contacts(const SurfacePlaces& places);

 private:
  // A shape, or its copy across periodic sides, or a corner of a mesh.
  struct Item {
    Index surface;  // number of the placed one, or of the corner (CornerSet)
    std::int8_t image;
    auto operator<=>(const Item&) const = default;
  };
  std::vector<std::vector<Item>> find_partners(std::span<const PlacedSurface> placed, Real skin) const;
  // Spheres, then corners near planes: by number.
  std::vector<Index> find_shapes(const SurfacePlaces& places, Real skin) const;
  int carrier_of(Index shape) const { return surfaces_.at(corners_.surface_of(shape)).carrier; }
  void find_surfaces(const SurfacePlaces& places, Real skin, const std::vector<Index>& shapes,
                     SurfaceRows& rows) const;
  void take_contacts(const SurfacePlaces& places);
  void list_items(const std::vector<Index>& shapes, const std::vector<std::vector<Item>>& partners);
  // Sets the items' positions and velocities to those of now, or of the start of the step. h: length of the
  // step that ends now [s], for velocities of its middle; 0: velocities of the instant.
  enum class Instant { now, start };
  void place(const SurfacePlaces& places, Instant when, Real h);
  void place_start(const SurfacePlaces& places, Real h);
  StepStart step_start(Real h) const;
  void find_pairs();
  CpuHistory::Listed listed(const SurfacePlaces& places) const {
    return {store_, list_, places, entries_.numbers()};
  }
  ContactViews<PackedRows> views(const HistoryViews& history) const;

  const Model& model_;
  const SurfaceSet& surfaces_;
  TouchRule rule_;
  CornerSet corners_;
  Vec3 period_, snap_;  // of the space [m]
  std::unique_ptr<ContactKernels> kernels_;
  std::vector<WallPlane> planes_;
  CpuSurfaces entries_;  // contacts with placed surfaces
  // The shapes and corners that can touch something, by number, then copies across periodic sides.
  std::vector<Item> items_;
  ParticleStore store_;
  NeighborList list_;
  std::vector<Vec3> arm_;
  std::vector<Vec4> start_position_, start_velocity_, start_spin_, mean_spin_;
  // What contacts remember after the last accepted step, and after the one that was found since.
  CpuHistory held_, found_;
  ShapeContacts kept_;  // while there is no list
  bool has_list_ = false, has_step_ = false;
  std::vector<BodyLoad> loads_;
  std::vector<BodyStep> steps_;
  std::vector<ShapeContact> with_shapes_;
  BodyPairs pairs_;
};

}  // namespace scree
