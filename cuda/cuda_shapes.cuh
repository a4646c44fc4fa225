// The bodies' shapes among the items on the GPU: their places and contacts. Few, they are the host's
// (ShapeSide); the device gets their places and writes their contacts to pinned memory, which the host
// awaits.
#pragma once

#include <vector>

#include "cuda_items.cuh"
#include "dem/shape_side.hpp"

namespace scree {

class CudaShapes {
 public:
  explicit CudaShapes(CudaItems& items);

  ShapeSide& side() { return side_; }
  const ShapeSide& side() const { return side_; }
  Index count() const { return items_.shape_items(); }
  ShapeBodies bodies() const { return {body_.data(), connected_offsets_.data(), connected_.data()}; }
  const Stream& stream() const { return stream_; }  // for what goes on beside the particles

  // When a list is built: names the shape items, which side() has laid out, and makes room for their
  // contacts.
  void name();
  void note_places() { list_places_ = side_.position(); }
  // Whether the list, with this skin [m], covers the shapes where they are placed now.
  bool covered_by(Real skin) const;

  // Moves the shapes to where the bodies are, on the host; put() brings them to the arrays of the state.
  void place() { side_.place(items_.layout); }
  void put();
  // Displacements by the last place(), on the device.
  const Vec3* upload_steps();

  // Contacts with the state now; over an implicit step; what these add to the ledger. They wait.
  void find_contacts();
  void find_contacts(const StepStart& start);
  void book_step(const StepStart& start);
  // Beside an explicit step: places the shapes among the items at position and velocity, and queues their
  // contacts with these, behind `ready`. take_contacts() waits for them.
  void queue_contacts(Vec4* position, Vec4* velocity, const Event& ready);
  void hold_until_placed(cudaStream_t stream) const { places_copied_.hold(stream); }
  void take_contacts() { take_contacts(ContactSpan::instant, stream_); }
  // The same where the step's kernel may still read the items' own shapes: from places of their own. Waits.
  void find_contacts_beside(const Vec4* position, const Vec4* velocity);
  void reduce_wrench(std::vector<BodyWrench>& end) const { side_.reduce(items_.layout, items_.ranks, end); }

 private:
  const Vec4* stage();
  void take_contacts(ContactSpan span, cudaStream_t stream);

  CudaItems& items_;
  ShapeSide side_;
  Stream stream_{Priority::urgent};
  DeviceArray<Index> body_, connected_offsets_, connected_;
  DeviceArray<Vec4> places_;  // positions, then velocities, where they are not those of all items
  DeviceArray<Vec3> step_;
  PinnedArray<Vec4> h_places_;
  Event places_copied_;
  std::vector<Vec4> list_places_;  // positions when the list was built
  PinnedArray<ShapeContact> h_contacts_;
  PinnedArray<ContactBooks> h_books_;
};

}  // namespace scree
