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
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <new>
#include <stdexcept>
#include <thread>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log.hpp"
#include "partition/entry_type.hpp"

namespace scree {
namespace {

MPI_Comm communicator_of(int handle) { return MPI_Comm_f2c(handle); }

// Bits of a number >= 0: they have the same order as the numbers, and a NaN is larger than all of them.
std::int64_t ordered_bits(Real value) {
  return std::bit_cast<std::int64_t>(std::isnan(value) ? std::numeric_limits<Real>::quiet_NaN()
                                                       : std::abs(value));
}

std::vector<int> offsets_of(const std::vector<int>& counts) {
  std::vector<int> offsets(counts.size());
  for (std::size_t r = 1; r < counts.size(); ++r)
    offsets[r] = mpi_count(as_size(offsets[r - 1]) + as_size(counts[r - 1]));
  return offsets;
}

// Calls visit(first, count) for pieces of [0, count) that one MPI call can handle.
template <class Visit>
void in_pieces(std::size_t count, std::size_t most, const Visit& visit) {
  for (std::size_t first = 0; first < count; first += most) visit(first, std::min(most, count - first));
}

constexpr int kDealTag = 11, kGatherTag = 12;
// Limits of a collective and of a single message [B]: MPI libraries occasionally lose larger ones.
constexpr std::size_t kMostEntries = std::size_t{1} << 28, kMostBytes = std::size_t{1} << 30;

// Kinds of errors that ranks share.
enum Failure { kNone, kInput, kSimulation, kDevice, kFile, kMemory };

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
  } catch (const std::filesystem::filesystem_error& error) {
    return {kFile, error.what()};
  } catch (const std::bad_alloc&) {
    return {kMemory, "not enough memory"};
  } catch (const std::exception& error) {
    return {kSimulation, error.what()};
  }
}

int exit_code_of(Failure kind) {
  if (kind == kInput || kind == kMemory) return static_cast<int>(ExitCode::bad_input);
  return static_cast<int>(kind == kFile ? ExitCode::io_failed : ExitCode::simulation_failed);
}

[[noreturn]] void throw_as(const Caught& failure) {
  if (failure.kind == kInput) throw InputError(failure.message);
  if (failure.kind == kDevice) throw DeviceError(failure.message);
  if (failure.kind == kFile) throw IoError(failure.message);
  if (failure.kind == kMemory) throw std::bad_alloc();
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

Real Ranks::sum_on_host(Real value) const {
  if (alone()) return value;
  MPI_Comm host;
  MPI_Comm_split_type(communicator_of(communicator_), MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &host);
  MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, host);
  MPI_Comm_free(&host);
  return value;
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
  MPI_Allreduce(MPI_IN_PLACE, bits.data(), as_index(values.size()), MPI_INT64_T, MPI_MAX,
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
  if (alone()) return;
  in_pieces(values.size(), kMostEntries, [&](std::size_t first, std::size_t count) {
    MPI_Allreduce(MPI_IN_PLACE, values.data() + first, mpi_count(count), MPI_INT64_T, MPI_SUM,
                  communicator_of(communicator_));
  });
}

std::int64_t Ranks::sum_below(std::int64_t value) const {
  std::int64_t below = 0;
  if (!alone()) MPI_Exscan(&value, &below, 1, MPI_INT64_T, MPI_SUM, communicator_of(communicator_));
  return is_root() ? 0 : below;  // the value of rank 0 is undefined
}

// Sums limbs of 32 bits each, which do not overflow for up to 2^31 ranks.
void Ranks::sum(std::span<__int128> values) const {
  if (alone()) return;
  constexpr int kLimbs = 4;
  std::vector<std::int64_t> limbs(values.size() * kLimbs);
  for (std::size_t k = 0; k < values.size(); ++k)
    for (int limb = 0; limb < kLimbs; ++limb)
      limbs[k * kLimbs + as_size(limb)] = static_cast<std::int64_t>(
          static_cast<std::uint32_t>(static_cast<unsigned __int128>(values[k]) >> (32 * limb)));
  sum(std::span<std::int64_t>(limbs));
  for (std::size_t k = 0; k < values.size(); ++k) {
    unsigned __int128 total = 0;
    for (int limb = 0; limb < kLimbs; ++limb)
      total += static_cast<unsigned __int128>(limbs[k * kLimbs + as_size(limb)]) << (32 * limb);
    values[k] = static_cast<__int128>(total);
  }
}

void Ranks::broadcast_bytes(void* data, std::size_t bytes, int from) const {
  in_pieces(bytes, kMostBytes, [&](std::size_t first, std::size_t count) {
    MPI_Bcast(static_cast<char*>(data) + first, mpi_count(count), MPI_BYTE, from,
              communicator_of(communicator_));
  });
}

void Ranks::broadcast_failure(std::exception_ptr failure, int from) const {
  Caught own = caught(failure);
  std::int64_t head[2] = {own.kind, std::ssize(own.message)};
  broadcast_bytes(head, sizeof head, from);
  if (head[0] == kNone) return;
  own.kind = static_cast<Failure>(head[0]);
  own.message.resize(as_size(head[1]));
  broadcast_bytes(own.message.data(), own.message.size(), from);
  throw_as(own);
}

// The message begins with whether there is a failure, whose text follows in messages of its own.
void Ranks::broadcast_with_failure(std::exception_ptr failure,
                                   std::initializer_list<std::span<std::byte>> values) const {
  std::vector<std::byte> message{failure ? std::byte{1} : std::byte{0}};
  for (const std::span<std::byte> part : values) message.insert(message.end(), part.begin(), part.end());
  broadcast_bytes(message.data(), message.size());
  if (message[0] != std::byte{0}) return broadcast_failure(failure);
  auto from = message.begin() + 1;
  for (const std::span<std::byte> part : values) {
    std::copy_n(from, part.size(), part.begin());
    from += std::ssize(part);
  }
}

namespace {

// Waits until a collective begun by this rank is complete, but at most for the given time.
bool done_within(MPI_Request& request, std::chrono::seconds patience) {
  const auto start = std::chrono::steady_clock::now();
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done) return true;
    const auto waited = std::chrono::steady_clock::now() - start;
    if (waited > patience) return false;
    // Usually all ranks arrive at the same time.
    if (waited < std::chrono::milliseconds(20))
      std::this_thread::yield();
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

void Ranks::throw_collectively(std::exception_ptr failure) const {
  constexpr auto kPatience = std::chrono::seconds(20);  // other ranks may be writing large files
  const int own = failure ? rank_ : size_;
  int first = size_;
  MPI_Request request;
  MPI_Iallreduce(&own, &first, 1, MPI_INT, MPI_MIN, communicator_of(communicator_), &request);
  if (!failure) {
    MPI_Wait(&request, MPI_STATUS_IGNORE);
  } else if (!done_within(request, kPatience)) {
    const Caught what = caught(failure);
    end_job(what.message.c_str(), exit_code_of(what.kind));
  }
  if (first < size_) broadcast_failure(first == rank_ ? failure : nullptr, first);
}

void Ranks::error_barrier(const char* message, int exit_code) const {
  if (alone()) return;
  MPI_Request request;
  MPI_Ibarrier(communicator_of(communicator_), &request);
  if (!done_within(request, std::chrono::seconds(5))) end_job(message, exit_code);
}

void Ranks::end_job(const char* message, int exit_code) const {
  std::fputs(message_line("error: rank " + std::to_string(rank_), message).c_str(), stderr);
  std::fflush(nullptr);
  MPI_Abort(communicator_of(communicator_), exit_code);
  std::abort();  // unreachable
}

std::vector<int> Ranks::counts_of(std::size_t own) const {
  const int count = mpi_count(own);
  std::vector<int> counts(as_size(size_));
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator_of(communicator_));
  return counts;
}

void Ranks::gather_bytes(const void* own, const std::vector<int>& counts, std::size_t element,
                         void* all) const {
  const EntryType type(element);
  const std::vector<int> offsets = offsets_of(counts);
  MPI_Allgatherv(own, counts[as_size(rank_)], type, all, counts.data(), offsets.data(), type,
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
  return as_size(count);
}

void Ranks::receive(int sender, void* data, std::size_t count, std::size_t element) const {
  const EntryType type(element);
  MPI_Recv(data, mpi_count(count), type, sender, kGatherTag, communicator_of(communicator_),
           MPI_STATUS_IGNORE);
}

void Ranks::stream_to_root(std::int64_t pieces, const std::function<Bytes(std::int64_t)>& give,
                           const std::function<void(int, std::int64_t, Bytes)>& take) const {
  const std::vector<std::int64_t> of_rank = gather(std::vector<std::int64_t>{pieces});
  if (!is_root()) {
    for (std::int64_t k = 0; k < pieces; ++k) {
      const Bytes piece = give(k);
      send_to_root(piece.data(), piece.size(), 1);
    }
  }
  std::exception_ptr failure;  // the remaining pieces are received nevertheless, because their senders wait
  const auto taken = [&](int rank, std::int64_t k, Bytes piece) {
    try {
      if (!failure) take(rank, k, piece);
    } catch (...) {
      failure = std::current_exception();
    }
  };
  for (std::int64_t k = 0; is_root() && k < pieces; ++k) taken(0, k, give(k));
  std::vector<std::byte> piece;
  for (int sender = 1; is_root() && sender < size_; ++sender)
    for (std::int64_t k = 0; k < of_rank[as_size(sender)]; ++k) {
      piece.resize(arriving(sender, 1));
      receive(sender, piece.data(), piece.size(), 1);
      taken(sender, k, piece);
    }
  on_root([&] {
    if (failure) std::rethrow_exception(failure);
  });
}

std::vector<std::int64_t> Ranks::all_to_all_counts(const std::vector<std::int64_t>& sent) const {
  std::vector<std::int64_t> received(sent.size());
  MPI_Alltoall(sent.data(), 1, MPI_INT64_T, received.data(), 1, MPI_INT64_T, communicator_of(communicator_));
  return received;
}

// The pieces of a long message arrive in the order of their sending.
void Ranks::all_to_all_bytes(const void* sent, const std::vector<std::int64_t>& sent_counts, void* received,
                             const std::vector<std::int64_t>& received_counts, std::size_t element) const {
  const EntryType type(element);
  const MPI_Comm communicator = communicator_of(communicator_);
  const std::size_t most = std::max<std::size_t>(1, kMostBytes / element);
  std::vector<MPI_Request> requests;
  char* to = static_cast<char*>(received);
  for (int r = 0; r < size_; ++r) {
    const auto count = as_size(received_counts[as_size(r)]);
    in_pieces(count, most, [&](std::size_t first, std::size_t piece) {
      MPI_Irecv(to + first * element, mpi_count(piece), type, r, kDealTag, communicator,
                &requests.emplace_back());
    });
    to += count * element;
  }
  const char* from = static_cast<const char*>(sent);
  for (int r = 0; r < size_; ++r) {
    const auto count = as_size(sent_counts[as_size(r)]);
    in_pieces(count, most, [&](std::size_t first, std::size_t piece) {
      MPI_Isend(from + first * element, mpi_count(piece), type, r, kDealTag, communicator,
                &requests.emplace_back());
    });
    from += count * element;
  }
  MPI_Waitall(mpi_count(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
}

}  // namespace scree
