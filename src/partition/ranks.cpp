#include "partition/ranks.hpp"

#include <mpi.h>
#if __has_include(<mpi-ext.h>)
#include <mpi-ext.h>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <thread>

#include "base/error.hpp"
#include "partition/entry_type.hpp"

namespace scree {
namespace {

MPI_Comm communicator_of(int handle) { return MPI_Comm_f2c(handle); }

// Bits of a number >= 0: they order as the numbers do, and a NaN comes after all of them.
std::int64_t ordered_bits(Real value) {
  return std::bit_cast<std::int64_t>(std::isnan(value) ? std::numeric_limits<Real>::quiet_NaN()
                                                       : std::abs(value));
}

std::vector<int> offsets_of(const std::vector<int>& counts) {
  std::vector<int> offsets(counts.size());
  for (std::size_t r = 1; r < counts.size(); ++r) offsets[r] = offsets[r - 1] + counts[r - 1];
  return offsets;
}

constexpr int kDealTag = 11, kGatherTag = 12;

// Kinds of failure that rank 0 shares.
enum Failure { kNone, kInput, kSimulation, kDevice, kFile };

struct Caught {
  Failure kind = kNone;
  std::string message;
};

Caught caught(const std::exception_ptr& failure) {
  if (!failure) return {};
  try {
    std::rethrow_exception(failure);
  } catch (const InputError& error) {
    return {kInput, error.what()};
  } catch (const DeviceError& error) {
    return {kDevice, error.what()};
  } catch (const IoError& error) {
    return {kFile, error.what()};
  } catch (const std::exception& error) {
    return {kSimulation, error.what()};
  }
}

[[noreturn]] void throw_as(const Caught& failure) {
  if (failure.kind == kInput) throw InputError(failure.message);
  if (failure.kind == kDevice) throw DeviceError(failure.message);
  if (failure.kind == kFile) throw IoError(failure.message);
  throw SimulationError(failure.message);
}

}  // namespace

Ranks Ranks::world() {
  Ranks ranks;
  int started = 0, ended = 0;
  MPI_Initialized(&started), MPI_Finalized(&ended);
  if (!started || ended) return ranks;
  MPI_Comm_rank(MPI_COMM_WORLD, &ranks.rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks.size_);
  ranks.communicator_ = MPI_Comm_c2f(MPI_COMM_WORLD);
  return ranks;
}

int Ranks::local_rank() const {
  if (alone()) return 0;
  MPI_Comm host;
  MPI_Comm_split_type(communicator_of(communicator_), MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &host);
  int local = 0;
  MPI_Comm_rank(host, &local);
  MPI_Comm_free(&host);
  return local;
}

bool Ranks::mpi_takes_device_memory() {
#if defined(MPIX_CUDA_AWARE_SUPPORT) && MPIX_CUDA_AWARE_SUPPORT
  return MPIX_Query_cuda_support() == 1;
#else
  return false;
#endif
}

Real Ranks::max(Real value) const {
  max({&value, 1});
  return value;
}

void Ranks::max(std::span<Real> values) const {
  if (alone()) return;
  constexpr std::size_t kMost = 16;
  std::array<std::int64_t, kMost> bits;
  if (values.size() > kMost) throw std::logic_error("Ranks::max: too many values at once");
  std::transform(values.begin(), values.end(), bits.begin(), ordered_bits);
  MPI_Allreduce(MPI_IN_PLACE, bits.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_MAX,
                communicator_of(communicator_));
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::bit_cast<Real>(bits[k]);
}

bool Ranks::any(bool value) const {
  if (alone()) return value;
  int flag = value;
  MPI_Allreduce(MPI_IN_PLACE, &flag, 1, MPI_INT, MPI_MAX, communicator_of(communicator_));
  return flag != 0;
}

std::int64_t Ranks::min(std::int64_t value) const {
  if (!alone()) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_MIN, communicator_of(communicator_));
  return value;
}

std::int64_t Ranks::sum(std::int64_t value) const {
  sum(std::span<std::int64_t>(&value, 1));
  return value;
}

void Ranks::sum(std::span<std::int64_t> values) const {
  if (alone() || values.empty()) return;
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T, MPI_SUM,
                communicator_of(communicator_));
}

// In limbs of 32 bits each, which add up without overflow over 2^31 ranks.
void Ranks::sum(std::span<__int128> values) const {
  if (alone()) return;
  constexpr int kLimbs = 4;
  std::vector<std::int64_t> limbs(values.size() * kLimbs);
  for (std::size_t k = 0; k < values.size(); ++k)
    for (int limb = 0; limb < kLimbs; ++limb)
      limbs[k * kLimbs + static_cast<std::size_t>(limb)] = static_cast<std::int64_t>(
          static_cast<std::uint32_t>(static_cast<unsigned __int128>(values[k]) >> (32 * limb)));
  sum(std::span<std::int64_t>(limbs));
  for (std::size_t k = 0; k < values.size(); ++k) {
    unsigned __int128 total = 0;
    for (int limb = 0; limb < kLimbs; ++limb)
      total += static_cast<unsigned __int128>(limbs[k * kLimbs + static_cast<std::size_t>(limb)])
               << (32 * limb);
    values[k] = static_cast<__int128>(total);
  }
}

void Ranks::broadcast_bytes(void* data, std::size_t bytes) const {
  if (bytes == 0) return;
  MPI_Bcast(data, static_cast<int>(bytes), MPI_BYTE, 0, communicator_of(communicator_));
}

void Ranks::share_failure(std::exception_ptr failure) const {
  Caught own = caught(failure);
  int head[2] = {own.kind, static_cast<int>(own.message.size())};
  broadcast_bytes(head, sizeof head);
  if (head[0] == kNone) return;
  own.kind = static_cast<Failure>(head[0]);
  own.message.resize(static_cast<std::size_t>(head[1]));
  broadcast_bytes(own.message.data(), own.message.size());
  throw_as(own);
}

void Ranks::meet(const char* message, int exit_code) const {
  if (alone()) return;
  constexpr auto kPatience = std::chrono::seconds(5);
  MPI_Request request;
  MPI_Ibarrier(communicator_of(communicator_), &request);
  const auto start = std::chrono::steady_clock::now();
  for (int here = 0;;) {
    MPI_Test(&request, &here, MPI_STATUS_IGNORE);
    if (here) return;
    const auto waited = std::chrono::steady_clock::now() - start;
    if (waited > kPatience) break;
    // Where all come, which is the rule, they come at once.
    if (waited < std::chrono::milliseconds(20))
      std::this_thread::yield();
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::fprintf(stderr, "error: rank %d: %s\n", rank_, message);
  std::fflush(nullptr);
  MPI_Abort(communicator_of(communicator_), exit_code);
}

std::vector<int> Ranks::counts_of(std::size_t own) const {
  const int count = mpi_count(own);
  std::vector<int> counts(static_cast<std::size_t>(size_));
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator_of(communicator_));
  return counts;
}

void Ranks::gather_bytes(const void* own, const std::vector<int>& counts, std::size_t element,
                         void* all) const {
  const EntryType type(element);
  const std::vector<int> offsets = offsets_of(counts);
  MPI_Allgatherv(own, counts[static_cast<std::size_t>(rank_)], type, all, counts.data(), offsets.data(), type,
                 communicator_of(communicator_));
}

void Ranks::send_to_root(const void* data, std::size_t count, std::size_t element) const {
  const EntryType type(element);
  MPI_Send(data, mpi_count(count), type, 0, kGatherTag, communicator_of(communicator_));
}

std::size_t Ranks::arriving(int sender, std::size_t element) const {
  const EntryType type(element);
  MPI_Status status;
  MPI_Probe(sender, kGatherTag, communicator_of(communicator_), &status);
  int count = 0;
  MPI_Get_count(&status, type, &count);
  return static_cast<std::size_t>(count);
}

void Ranks::receive(int sender, void* data, std::size_t count, std::size_t element) const {
  const EntryType type(element);
  MPI_Recv(data, mpi_count(count), type, sender, kGatherTag, communicator_of(communicator_),
           MPI_STATUS_IGNORE);
}

std::vector<int> Ranks::deal_counts(const std::vector<int>& sent) const {
  std::vector<int> received(sent.size());
  MPI_Alltoall(sent.data(), 1, MPI_INT, received.data(), 1, MPI_INT, communicator_of(communicator_));
  return received;
}

void Ranks::deal_bytes(const void* sent, const std::vector<int>& sent_counts, void* received,
                       const std::vector<int>& received_counts, std::size_t element) const {
  const EntryType type(element);
  const MPI_Comm communicator = communicator_of(communicator_);
  const std::vector<int> from = offsets_of(sent_counts), to = offsets_of(received_counts);
  std::vector<MPI_Request> requests;
  for (int r = 0; r < size_; ++r) {
    const auto at = static_cast<std::size_t>(r);
    if (received_counts[at] > 0)
      MPI_Irecv(static_cast<char*>(received) + static_cast<std::size_t>(to[at]) * element,
                received_counts[at], type, r, kDealTag, communicator, &requests.emplace_back());
  }
  for (int r = 0; r < size_; ++r) {
    const auto at = static_cast<std::size_t>(r);
    if (sent_counts[at] > 0)
      MPI_Isend(static_cast<const char*>(sent) + static_cast<std::size_t>(from[at]) * element,
                sent_counts[at], type, r, kDealTag, communicator, &requests.emplace_back());
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

}  // namespace scree
