// Interface of the GPU's backend. With SCREE_CUDA cuda/ defines these functions, else no_device.cpp does.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "dem/backend/backend.hpp"
#include "model/data/model.hpp"

namespace scree {

// The deck names a transport between GPUs that does not work here. The message lists those that do.
struct TransportError : InputError {
  using InputError::InputError;
};

// Assigns a GPU to each rank of a host, round robin where there are fewer GPUs; a single rank keeps the
// first. The functions below refer to that GPU. Collective.
void choose_device(const Ranks& ranks);

// Reason why this program cannot use a GPU on this machine, for the user; empty if it can.
std::string device_error();

// "NVIDIA H200, 132 multiprocessors, 150 GB"; only where device_error() is empty.
std::string device_name();

// Device memory that is free now [B]; only where device_error() is empty.
std::size_t free_device_memory();

// Device memory that the program holds now [B].
std::size_t device_memory_in_use();

// Device memory that groups of arrays of this rank's backend hold [B]; empty for the CPU's.
struct DeviceShare {
  const char* of;
  std::size_t bytes;
};
std::vector<DeviceShare> device_shares(const Backend& backend);

// Size of a neighbour list on the device: initial slots per particle, enough for a bed of equal particles,
// and the slack where more were needed.
double slots_per_particle(const Model& model);
inline constexpr double kListSlack = 1.05;

// Particles whose records are copied from the device at a time. Their buffer is always allocated, so that a
// run without free memory can still write its last good state.
inline constexpr std::size_t kRecordsAtOnce = std::size_t{1} << 16;
// Rows of contact history that are copied at a time, with a buffer for this many contacts per row, more than
// packings have.
inline constexpr Index kRowsAtOnce = Index{1} << 16;
inline constexpr std::size_t kContactsPerRow = 8;
// Contact lines of a snapshot that are copied at a time; the buffer is allocated once they are used.
inline constexpr std::size_t kLinesAtOnce = std::size_t{1} << 18;

// Device memory that the backend needs for this rank's part of the model [B], printed by `scree check`. The
// estimate depends on the model alone, also on machines without a GPU.
std::size_t device_memory(const Model& model);
// Device memory of the meshes [B], without that of the particles near them: arrays, trees, and the
// dissipation at each triangle where it is an output.
std::size_t device_memory_of_meshes(const Model& model);
// Additional device memory of a particle with a contact near a mesh [B]. device_memory() counts those that
// are near one at the start.
std::size_t device_memory_near_mesh(const Model& model);

// Memory that one rank needs on its GPU.
struct DeviceClaim {
  std::array<char, 16> device;  // the GPU's name, unique among those of all hosts
  std::size_t needed, free;     // [B]
};

// The claim of this rank; only where device_error() is empty.
DeviceClaim claim_device(const Model& model);

// Total memory that all ranks need on the GPU of rank `own`. claims: of all ranks.
struct DeviceLoad {
  int ranks = 0;
  std::size_t needed = 0, free = 0;  // [B]
};
DeviceLoad load_of_device(std::span<const DeviceClaim> claims, int own);

// Reason why the GPU of rank `own` is too small for all its ranks; empty if it is not. claims: of all ranks.
// name: device_name() on that rank.
std::string device_memory_trouble(std::span<const DeviceClaim> claims, int own, const std::string& name);

// Assigns GPUs to the ranks of each host. Throws InputError, on all ranks, where one has no usable GPU, or
// where the parts of the model on one GPU do not fit into its free memory. Collective.
std::unique_ptr<Backend> make_cuda_backend(const Model& model, const Ranks& ranks = {});

}  // namespace scree
