// The contact stages on the device: the items of src/dem, launched. All pointers in views and outputs are the
// device's. The CPU's counterpart is CpuContactKernels in src/dem/contact_kernels.cpp.
#pragma once

#include "dem/contact_items.hpp"
#include "dem/contact_kernels.hpp"
#include "dem/step_items.hpp"
#include "device.cuh"

namespace scree {

// Elastic: LinearElastic or PowerElastic; Laws: OneLaw, or LawTable with its table on the device.
template <class Elastic, class Laws>
class DeviceContactKernels {
 public:
  DeviceContactKernels(Device device, Laws laws) : device_(device), laws_(laws) {}

  void forces(const ContactViews& in, Vec3 gravity, Index n, Vec3* force, Real* loss_power) const;
  void verlet_finish(const ContactViews& in, Vec3 gravity, Index n, const VerletViews& state, Vec3* force) const;
  // d_squared: the square of the largest displacement [m^2], on the device.
  void verlet_advance(const ContactViews& in, Vec3 gravity, Index n, const VerletViews& state, Real* d_squared) const;
  void system(const ContactViews& in, Vec3 gravity, Index n, NewtonWeights weights, const StepStart& start,
              const StepForces& out, const ContactMatrix& matrix) const;
  // Contacts of shapes over an implicit step, and at one instant.
  void shapes(const ContactViews& in, Index n, const StepStart& start, ShapeContact* out) const;
  void shapes(const ContactViews& in, Index n, ShapeContact* out) const;
  void energies(const ContactViews& in, Index n, const EnergyOutputs& out) const;

 private:
  Device device_;
  Laws laws_;
};

}  // namespace scree
