#include "contact_kernels.cuh"

#include "for_each.cuh"

namespace scree {

template <class Elastic, class Laws>
void DeviceContactKernels<Elastic, Laws>::forces(const ContactViews& in, Vec3 gravity, Index n, Vec3* force,
                                                 Real* loss_power) const {
  for_each(device_, n, ContactForceItem<Elastic, Laws>{in, laws_, gravity, force, loss_power});
}

template <class Elastic, class Laws>
void DeviceContactKernels<Elastic, Laws>::verlet_finish(const ContactViews& in, Vec3 gravity, Index n,
                                                        const VerletViews& state, Vec3* force) const {
  for_each(device_, n, VerletFinishItem<Elastic, Laws>{{in, laws_, gravity, force, state.loss_power}, state});
}

template <class Elastic, class Laws>
void DeviceContactKernels<Elastic, Laws>::verlet_advance(const ContactViews& in, Vec3 gravity, Index n,
                                                         const VerletViews& state, Real* d_squared) const {
  const VerletAdvanceItem<Elastic, Laws> item{{in, laws_, gravity, nullptr, nullptr}, state};
  max_over(device_, n, item, d_squared);
}

template <class Elastic, class Laws>
void DeviceContactKernels<Elastic, Laws>::system(const ContactViews& in, Vec3 gravity, Index n, NewtonWeights weights,
                                                 const StepStart& start, const StepForces& out,
                                                 const ContactMatrix& matrix) const {
  for_each(device_, n, ContactSystemItem<Elastic, Laws>{{in, laws_, start}, gravity, weights, out, matrix});
}

template <class Elastic, class Laws>
void DeviceContactKernels<Elastic, Laws>::shapes(const ContactViews& in, Index n, const StepStart& start,
                                                 ShapeContact* out) const {
  for_each(device_, n, ShapeStepItem<Elastic, Laws>{{in, laws_, start}, out});
}

template <class Elastic, class Laws>
void DeviceContactKernels<Elastic, Laws>::shapes(const ContactViews& in, Index n, ShapeContact* out) const {
  for_each(device_, n, ShapeContactItem<Elastic, Laws>{in, laws_, out});
}

template <class Elastic, class Laws>
void DeviceContactKernels<Elastic, Laws>::energies(const ContactViews& in, Index n, const EnergyOutputs& out) const {
  for_each(device_, n, ContactEnergyItem<Elastic, Laws>{in, laws_, out.energy, out.contacts, out.pairs});
}

template class DeviceContactKernels<LinearElastic, OneLaw>;
template class DeviceContactKernels<LinearElastic, LawTable>;
template class DeviceContactKernels<PowerElastic, OneLaw>;
template class DeviceContactKernels<PowerElastic, LawTable>;

}  // namespace scree
