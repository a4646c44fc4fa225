// The stages of the step that need no neighbours, on the device. All pointers in the items are the device's.
#pragma once

#include "dem/step_items.hpp"
#include "device.cuh"

namespace scree {

void newmark(Device device, Index n, const NewmarkItem& item);
void residual(Device device, Index n, const ResidualItem& item);
void subtract_matrix(Device device, Index n, const SubtractMatrixItem& item);
void accept(Device device, Index n, const AcceptItem& item);
// d_squared: the square of the largest displacement [m^2], on the device.
void verlet_start(Device device, Index n, const VerletStartItem& item, Real* d_squared);

}  // namespace scree
