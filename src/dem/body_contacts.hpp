// Contacts of bodies with each other and with walls: few, they are all rank 0's, on the host.
#pragma once

#include <compare>
#include <memory>
#include <span>
#include <vector>

#include "dem/body_items.hpp"
#include "dem/contact_kernels.hpp"
#include "dem/surfaces.hpp"
#include "model/model.hpp"
#include "model/touching.hpp"
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

class BodyContacts {
 public:
  BodyContacts(const Model& model, const SurfaceSet& surfaces, const Subdomain& subdomain);

  // Finds what can touch before one of the surfaces has moved by half the skin [m]. Other ranks than 0 leave
  // it.
  void build(std::span<const PlacedSurface> placed, Real skin);
  // The contacts at an instant, and over an implicit step. All spans: of the surfaces on bodies.
  void find(std::span<const PlacedSurface> placed);
  void find(std::span<const PlacedSurface> placed, std::span<const PlacedSurface> start, Real h);
  // Of the last find(): one per surface that can touch something, in order.
  const std::vector<BodyLoad>& loads() const { return loads_; }
  const std::vector<BodyStep>& steps() const { return steps_; }
  // Sums over the former [W], [J], number.
  Real loss_power() const;
  Real elastic_energy() const;
  Real pairs() const;
  // What the bodies do to a wall, where they were at the last find() at an instant. wall: index into
  // Model::walls.
  ContactSum on_wall(int wall) const;

 private:
  // A surface, or its copy across periodic sides.
  struct Item {
    Index surface;
    std::int8_t image;
    auto operator<=>(const Item&) const = default;
  };
  std::vector<std::vector<Item>> find_partners(std::span<const PlacedSurface> placed, Real skin) const;
  ContactViews<PackedRows> views() const;
  void place(std::span<const PlacedSurface> placed, std::vector<Vec4>& position, std::vector<Vec4>& velocity,
             std::vector<Vec3>& arm) const;

  const Model& model_;
  const SurfaceSet& surfaces_;
  const Subdomain& subdomain_;
  TouchRule rule_;
  std::unique_ptr<ContactKernels> kernels_;
  std::vector<WallPlane> planes_;
  // Those that can touch something, ordered by surface, then copies across periodic sides.
  std::vector<Item> items_;
  Index originals_ = 0;
  std::vector<Index> offsets_, neighbors_, wall_offsets_, walls_;  // rows of the originals
  std::vector<Vec4> position_, velocity_, start_position_, start_velocity_;
  std::vector<Vec3> arm_;
  std::vector<int> material_;
  std::vector<BodyLoad> loads_;
  std::vector<BodyStep> steps_;
};

}  // namespace scree
