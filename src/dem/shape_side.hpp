// The bodies' shapes among the items of a backend: where they are, what their contacts sum to, what they
// lose. Few and small beside the particles, they live on the host for every backend.
#pragma once

#include <span>
#include <vector>

#include "dem/body_shapes.hpp"
#include "dem/neighbor_list.hpp"
#include "dem/shape_items.hpp"
#include "model/body_exchange.hpp"
#include "model/model.hpp"
#include "partition/ranks.hpp"
#include "partition/subdomain.hpp"

namespace scree {

// Of the shapes' own share of their contacts (with other bodies' shapes and with walls).
struct ShapeLosses {
  Real contact_loss = 0;     // dissipated since t = 0 [J]
  Real loss_power = 0;       // the same at t_n, with velocity-Verlet [W]
  Real integrator_loss = 0;  // taken out by HHT since t = 0 [J]
};

// What touches a body or a wall, and what it does to it.
struct ContactSum {
  Vec3 force;   // [N]
  Vec3 torque;  // about the body's centre or the wall's point [N m]
  std::int64_t contacts = 0;
};

struct ShapePack {
  std::vector<int> body;
  std::vector<Real> radius;
  std::vector<Vec3> position, velocity, force;
  std::vector<int> contacts;
};

class ShapeSide {
 public:
  ShapeSide(const Model& model, const Subdomain& subdomain);

  const BodyShapes& shapes() const { return shapes_; }
  void set_motion(std::span<const BodyMotion> motion) { motion_.assign(motion.begin(), motion.end()); }
  // Brings each shape into the periodic box and finds its images; fills the shapes' part of the layout, whose
  // owned particles and ghosts are known.
  void lay_out(Real width, ItemLayout& layout);
  std::int64_t row_key_of(const ItemLayout& layout, Index item) const;
  // Moves the shape items to where the bodies are; returns the largest displacement of one [m].
  Real place(const ItemLayout& layout);

  // One entry per shape item, indexed from ItemLayout::first_shape.
  const std::vector<Vec4>& position() const { return position_; }  // x, y, z, radius
  const std::vector<Vec4>& velocity() const { return velocity_; }  // x, y, z, infinite mass
  const std::vector<Vec3>& step() const { return step_; }          // displacement by the last place() [m]
  std::vector<ShapeContact>& contacts() { return contacts_; }      // filled by the backend
  // The same from memory that a device has written.
  void take_contacts(ContactSpan span, std::span<const ShapeContact> found);

  // reduce_wrench: brings the shapes' contacts() of all ranks to rank 0, one message per rank, and sums them
  // up to the contact wrenches on the bodies for the step and at its end, or at its end alone; on other ranks
  // they come out as zero. Collective.
  void reduce(const ItemLayout& layout, const Ranks& ranks, ContactWrenches& step,
              std::vector<BodyWrench>& end) const;
  void reduce(const ItemLayout& layout, const Ranks& ranks, std::vector<BodyWrench>& end) const;
  // Books the dissipation of an explicit step of length h from contacts(): trapezoidal, like the particles'.
  void book_losses(Real h);
  // Books an implicit step, from one entry per shape item.
  void book_step(std::span<const ContactBooks> items);
  ShapeLosses& losses() { return losses_; }
  const ShapeLosses& losses() const { return losses_; }
  // Shapes' share of the contacts' elastic energy [J] and of their number.
  Real elastic_energy() const;
  Real pairs() const;
  // Per body, from contacts() at an instant. Collective; on rank 0, zero elsewhere.
  std::vector<ContactSum> body_contacts(const ItemLayout& layout, const Ranks& ranks) const;
  // Collective; complete on rank 0.
  ShapePack pack(const ItemLayout& layout, const Ranks& ranks) const;

 private:
  // A shape that is touched, and what its contacts sum to; what they have no meaning for at an instant
  // travels along.
  struct Touched {
    Index shape;
    ShapeForces forces;
  };
  Vec3 arm_of(const ShapeItem& shape) const;  // from the centre of its body [m]
  std::vector<Touched> touched(const ItemLayout& layout, const Ranks& ranks) const;
  // Calls visit(shape, forces) for the touched shapes of all ranks, on rank 0.
  template <class Visit>
  void for_each_touched(const ItemLayout& layout, const Ranks& ranks, const Visit& visit) const;

  const Subdomain& subdomain_;
  BodyShapes shapes_;
  std::vector<BodyMotion> motion_;  // of the bodies as last set
  std::vector<ImageCount> image_;   // of each shape when it was laid out
  std::vector<Vec4> position_, velocity_;
  std::vector<Vec3> step_;
  std::vector<ShapeContact> contacts_;
  ShapeLosses losses_;
};

}  // namespace scree
