// Contacts of bodies' shapes with each other and with all other surfaces. They are few: rank 0 computes all
// of them on the host, with shapes as the items of a neighbour list.
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
#include "dem/search/list_rows.hpp"
#include "dem/surface_contact/body_items.hpp"
#include "dem/surface_contact/body_pairs.hpp"
#include "dem/surfaces/corner_set.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "model/data/model.hpp"
#include "model/derived/touching.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Sum of the contacts of a body or a wall.
struct ContactSum {
  Vec3 force;   // [N]
  Vec3 torque;  // about the body's centre or the wall's point [N m]
  std::int64_t contacts = 0;

  ContactSum& operator+=(const ContactSum& other) {
    force += other.force, torque += other.torque, contacts += other.contacts;
    return *this;
  }
};

// Contact sum from the sums of `WallContactItem`, indexed by `WallTerm`.
ContactSum make_wall_contact(const Real* sums);

// Totals over all contacts of shapes at an instant, or over the explicit step that ended there.
struct BodyContactTotals {
  Real loss_power = 0;        // [W]
  Real elastic_energy = 0;    // [J]
  SpringEnergies springs;     // parts of elastic_energy
  Real cohesion = 0;          // part of elastic_energy [J]
  TangentialLosses losses{};  // over the step [J]
  Real pairs = 0;             // number of contacts
};

class BodyContacts {
 public:
  BodyContacts(const Model& model, const SurfaceSet& surfaces, const Subdomain& subdomain);

  // Packs the contact history by keys before surfaces are wrapped into the periodic box for another list.
  void pack_list(const SurfacePoses& poses);
  // Finds possible contacts until some surface has moved by half the skin [m]. Called on rank 0 only.
  void build(const SurfacePoses& poses, Real skin);

  // Evaluates the contacts at an instant (h = 0), or over the explicit step of length h that ends now; and
  // over an implicit step that began at `poses.start`.
  void find_loads(const SurfacePoses& poses, Real h);
  void find_steps(const SurfacePoses& poses, Real h);
  // Adds the sums of the last evaluation; a surface may occur twice.
  void add_sums(std::vector<InstantSums>& to) const;
  void add_sums(std::vector<StepSums>& to) const;
  std::vector<PairStiffness> pairs() const { return pairs_.blocks(); }  // of `find_steps`
  BodyContactTotals totals() const;                                     // of `find_loads`
  BodyStep step_totals() const;                                         // of `find_steps`; without sums
  std::vector<TriangleSums> triangle_sums() const;                      // of `find_loads`
  // Load of shapes on a static wall at the last evaluation at an instant. wall: index into Model::walls.
  ContactSum on_wall(int wall);
  // Contacts of `find_loads` at an instant, each one once.
  std::vector<ContactLine> lines(const SurfacePoses& poses);

  // Accumulates the dissipation of the last evaluation at the triangles of meshes: over an explicit step of
  // length h, and over an implicit one.
  void accumulate_load_works(const SurfacePoses& poses, Real h);
  void accumulate_step_works(const SurfacePoses& poses);
  std::vector<std::int64_t> works() const { return entries_.works(); }
  void clear_works() { entries_.load_works({}); }

  // accept(): commits the history of the last evaluated step, if there is one; drop(): discards it; reopen():
  // the last accepted step will be evaluated again.
  void accept();
  void drop() { has_step_ = false; }
  void reopen();
  // Packed history of the contacts; that of another law is ignored. load: before the first list.
  void load(const ShapeContacts& contacts);
  ShapeContacts contacts(const SurfacePoses& poses);

 private:
  // A shape, one of its periodic images, or a vertex of a mesh.
  struct Item {
    Index surface;  // number of the placed surface, or of the vertex (`CornerSet`)
    std::int8_t image;
    auto operator<=>(const Item&) const = default;
  };
  std::vector<std::vector<Item>> find_partners(std::span<const SurfacePose> placed, Real skin) const;
  // Spheres, then vertices near planes, by number.
  std::vector<Index> find_shapes(const SurfacePoses& poses, Real skin) const;
  int parent_of(Index shape) const { return surfaces_.at(corners_.surface_of(shape)).parent; }
  void find_surfaces(const SurfacePoses& poses, Real skin, const std::vector<Index>& shapes,
                     SurfaceRows& rows) const;
  void unpack_shape_contacts(const SurfacePoses& poses);
  void list_items(const std::vector<Index>& shapes, const std::vector<std::vector<Item>>& partners);
  // Sets positions and velocities of the items to those of now, or of the start of the step. h: length of the
  // step that ends now [s], for mid-step velocities; 0: velocities of the instant.
  enum class Instant { now, start };
  void set_items(const SurfacePoses& poses, Instant when, Real h);
  void set_start_items(const SurfacePoses& poses, Real h);
  StepStart step_start(Real h) const;
  void find_pairs();
  CpuHistory::Listed listed(const SurfacePoses& poses) const {
    return {store_, list_, poses, entries_.numbers()};
  }
  ContactViews<PackedRows> views(const HistoryViews& history) const;

  const Model& model_;
  const SurfaceSet& surfaces_;
  TouchRule rule_;
  CornerSet corners_;
  Vec3 period_, snap_;  // of the domain [m]
  std::unique_ptr<ContactKernels> kernels_;
  std::vector<WallPlane> planes_;
  CpuSurfaces entries_;  // contacts with placed surfaces
  // Shapes and vertices with possible contacts, by number, then periodic images.
  std::vector<Item> items_;
  ParticleStore store_;
  NeighborList list_;
  std::vector<Vec3> arm_;
  std::vector<Vec4> start_position_, start_velocity_, start_spin_, mean_spin_;
  // Contact history after the last accepted step, and after the step evaluated since.
  CpuHistory accepted_, trial_;
  ShapeContacts packed_;  // packed history, while there is no list
  bool has_list_ = false, has_step_ = false;
  std::vector<BodyLoad> loads_;
  std::vector<BodyStep> steps_;
  std::vector<ShapeContact> with_shapes_;
  BodyPairs pairs_;
};

}  // namespace scree
