// The GPU's backend as the rest of the program sees it. With SCREE_CUDA the room cuda/ defines these
// functions, without it no_device.cpp does.
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

// The deck forces a transport between GPUs that does not work here. The message says which ones do.
struct TransportError : InputError {
  using InputError::InputError;
};

// Takes a GPU of its own for each rank of a host, in turn where there are fewer; one rank alone stays with
// the first. The functions below are about that GPU. Collective.
void choose_device(const Ranks& ranks);

// Why this program cannot use a GPU on this machine, in words for the user; empty if it can.
std::string device_trouble();

// "NVIDIA H200, 132 multiprocessors, 150 GB"; only where device_trouble() is empty.
std::string device_name();

// Device memory that is free now [B]; only where device_trouble() is empty.
std::size_t free_device_memory();

// Device memory that the program holds now [B].
std::size_t device_memory_in_use();

// What groups of arrays of this rank's backend hold of it [B]; empty for the CPU's.
struct DeviceShare {
  const char* of;
  std::size_t bytes;
};
std::vector<DeviceShare> device_shares(const Backend& backend);

// Room of a neighbour list on the device: slots per particle at the start, as many as a bed of equal
// particles needs, and over what was needed where that is more.
double slots_per_particle(const Model& model);
inline constexpr double kListSlack = 1.05;

// Particles whose records leave the device at a time. Room for them is there all the time: a run that finds
// no more memory writes its last good state through it.
inline constexpr std::size_t kRecordsAtOnce = std::size_t{1} << 16;
// Rows of what contacts remember likewise, with room for so many contacts in each, more than packings have.
inline constexpr Index kRowsAtOnce = Index{1} << 16;
inline constexpr std::size_t kRoomInRows = 8;
// Lines of a snapshot's contacts likewise; room for them is there once they are asked for.
inline constexpr std::size_t kLinesAtOnce = std::size_t{1} << 18;

// Device memory that the backend takes for this rank's part of the model [B]: what `scree check` prints. An
// estimate from the model alone, the same on machines without a GPU.
std::size_t device_memory(const Model& model);
// Device memory of the meshes [B], without that of the particles near them: arrays and trees, and the losses
// of contacts at each triangle where the output asks for these.
std::size_t device_memory_of_meshes(const Model& model);

// What one rank asks of its GPU.
struct DeviceClaim {
  std::array<char, 16> device;  // the GPU's name, unique among those of all hosts
  std::size_t needed, free;     // [B]
};

// Of this rank; only where device_trouble() is empty.
DeviceClaim claim_device(const Model& model);

// What all ranks that use the GPU of rank `own` ask of it. claims: of all ranks.
struct DeviceLoad {
  int ranks = 0;
  std::size_t needed = 0, free = 0;  // [B]
};
DeviceLoad load_of_device(std::span<const DeviceClaim> claims, int own);

// Why the GPU of rank `own` is too small for all ranks that use it; empty if it is not. claims: of all ranks.
// name: device_name() on that rank.
std::string device_memory_trouble(std::span<const DeviceClaim> claims, int own, const std::string& name);

// Each rank of a host takes a GPU of its own, as far as there are so many. Throws InputError, on all ranks,
// where there is no usable GPU on one, or where the parts of the model on one GPU do not fit into its free
// memory. Collective.
std::unique_ptr<Backend> make_cuda_backend(const Model& model, const Ranks& ranks = {});

}  // namespace scree
