// The ranks of a run, and exact collectives for decisions and sums. The result of a collective is the same on
// every rank and for every number of ranks. A single rank makes no MPI calls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <initializer_list>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "base/types.hpp"

namespace scree {

class Ranks {
 public:
  Ranks() = default;  // a single rank
  // All ranks of the job; a single rank if MPI has not been started.
  static Ranks world();

  int rank() const { return rank_; }
  int size() const { return size_; }
  bool is_root() const { return rank_ == 0; }
  bool alone() const { return size_ == 1; }
  // Number of this rank among the ranks of its host. Collective.
  int local_rank() const;
  // Sum over the ranks of this rank's host, with round-off. Collective.
  Real sum_on_host(Real value) const;
  // Whether the MPI library reports that it can read and write device memory.
  static bool mpi_takes_device_memory();
  int communicator() const { return communicator_; }  // Fortran handle; for the other files of this folder

  // Largest of values >= 0; a NaN on one rank makes the result a NaN. Collective, as are all functions below.
  Real max(Real value) const;
  void max(std::span<Real> values) const;
  bool any(bool value) const;
  // Smallest value of all ranks.
  std::int64_t min(std::int64_t value) const;
  // Exact sums; sums of 128 bits are modulo 2^128.
  std::int64_t sum(std::int64_t value) const;
  void sum(std::span<std::int64_t> values) const;
  void sum(std::span<__int128> values) const;
  // Sum over the ranks below this one.
  std::int64_t sum_below(std::int64_t value) const;

  // Sets the value to rank 0's on every rank.
  template <class T>
  void broadcast(T& value) const {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!alone()) broadcast_bytes(&value, sizeof(T));
  }
  template <class T>
  void broadcast(std::span<T> values) const {
    static_assert(std::is_trivially_copyable_v<T>);
    if (!alone()) broadcast_bytes(values.data(), values.size_bytes());
  }
  // Entries of all ranks in the order of the ranks, on rank 0; other ranks get none. One message per rank.
  // Throws std::length_error if a rank has more entries than an int can count; all_gather() does so if
  // all ranks together have.
  template <class T>
  std::vector<T> gather(std::vector<T> values) const;
  // Entries of all ranks in the order of the ranks, on every rank.
  template <class T>
  std::vector<T> all_gather(std::vector<T> values) const;
  // All-to-all: sends to[r] to rank r, and returns the received entries in the order of the senders.
  template <class T>
  std::vector<T> all_to_all(const std::vector<std::vector<T>>& to) const;
  // All-to-all for values in the order of their receivers, counts[r] of them for rank r.
  template <class T>
  std::vector<T> all_to_all(std::span<const T> values, const std::vector<std::int64_t>& counts) const;

  // Passes pieces of bytes of all ranks to rank 0 one by one, in the order of the ranks: give(k) returns this
  // rank's piece k, and take(rank, k, piece) runs on rank 0, which holds a single piece at a time. A piece
  // must be smaller than 2 GiB. Exceptions of `take` are thrown on every rank.
  using Bytes = std::span<const std::byte>;
  void stream_to_root(std::int64_t pieces, const std::function<Bytes(std::int64_t)>& give,
                      const std::function<void(int, std::int64_t, Bytes)>& take) const;

  // Runs an action on rank 0. Its exceptions (input, simulation, device, file) are thrown on every rank, with
  // the same message.
  template <class Action>
  void on_root(const Action& action) const {
    if (alone()) return action();
    std::exception_ptr failure;
    try {
      if (is_root()) action();
    } catch (...) {
      failure = std::current_exception();
    }
    broadcast_failure(failure);
  }
  // The same, followed by a broadcast of values that the action may set; all of it is one message.
  template <class Action, class... Values>
  void on_root(const Action& action, std::span<Values>... values) const {
    static_assert((std::is_trivially_copyable_v<Values> && ...));
    if (alone()) return action();
    std::exception_ptr failure;
    try {
      if (is_root()) action();
    } catch (...) {
      failure = std::current_exception();
    }
    broadcast_with_failure(failure, {std::as_writable_bytes(values)...});
  }

  // Collective try: runs an action on every rank. If it throws on some ranks, all ranks throw the exception
  // of the lowest of those. If other ranks do not return, because they wait for the failed one within the
  // action, its message is printed and the job ends.
  template <class Action>
  void collectively(const Action& action) const {
    if (alone()) return action();
    std::exception_ptr failure;
    try {
      action();
    } catch (...) {
      failure = std::current_exception();
    }
    throw_collectively(failure);
  }

  // Error barrier: called by every rank that ends with an error, before it exits. If some ranks do not call
  // it, the error belongs to this rank alone: its message is printed, and the job ends with the exit code.
  void error_barrier(const char* message, int exit_code) const;

 private:
  void broadcast_bytes(void* data, std::size_t bytes, int from = 0) const;
  void broadcast_failure(std::exception_ptr failure, int from = 0) const;
  void broadcast_with_failure(std::exception_ptr failure,
                              std::initializer_list<std::span<std::byte>> values) const;
  void throw_collectively(std::exception_ptr failure) const;
  [[noreturn]] void end_job(const char* message, int exit_code) const;
  // element: size of an entry [B].
  void send_to_root(const void* data, std::size_t count, std::size_t element) const;
  // Number of entries in the sender's next message.
  std::size_t arriving(int sender, std::size_t element) const;
  void receive(int sender, void* data, std::size_t count, std::size_t element) const;
  std::vector<int> counts_of(std::size_t own) const;
  void gather_bytes(const void* own, const std::vector<int>& counts, std::size_t element, void* all) const;
  std::vector<std::int64_t> all_to_all_counts(const std::vector<std::int64_t>& sent) const;
  void all_to_all_bytes(const void* sent, const std::vector<std::int64_t>& sent_counts, void* received,
                        const std::vector<std::int64_t>& received_counts, std::size_t element) const;

  int rank_ = 0, size_ = 1, communicator_ = 0;
};

template <class T>
std::vector<T> Ranks::gather(std::vector<T> values) const {
  static_assert(std::is_trivially_copyable_v<T>);
  if (alone()) return values;
  if (!is_root()) {
    send_to_root(values.data(), values.size(), sizeof(T));
    return {};
  }
  for (int sender = 1; sender < size_; ++sender) {
    const std::size_t before = values.size(), count = arriving(sender, sizeof(T));
    values.resize(before + count);
    receive(sender, values.data() + before, count, sizeof(T));
  }
  return values;
}

template <class T>
std::vector<T> Ranks::all_gather(std::vector<T> values) const {
  static_assert(std::is_trivially_copyable_v<T>);
  if (alone()) return values;
  const std::vector<int> counts = counts_of(values.size());
  std::size_t total = 0;
  for (const int count : counts) total += as_size(count);
  std::vector<T> all(total);
  gather_bytes(values.data(), counts, sizeof(T), all.data());
  return all;
}

template <class T>
std::vector<T> Ranks::all_to_all(std::span<const T> values, const std::vector<std::int64_t>& counts) const {
  static_assert(std::is_trivially_copyable_v<T>);
  if (alone()) return {values.begin(), values.end()};
  const std::vector<std::int64_t> received = all_to_all_counts(counts);
  std::vector<T> in(as_size(std::accumulate(received.begin(), received.end(), std::int64_t{0})));
  all_to_all_bytes(values.data(), counts, in.data(), received, sizeof(T));
  return in;
}

template <class T>
std::vector<T> Ranks::all_to_all(const std::vector<std::vector<T>>& to) const {
  if (alone()) return to[0];
  std::vector<std::int64_t> counts;
  std::vector<T> out;
  for (const std::vector<T>& part : to) {
    counts.push_back(std::ssize(part));
    out.insert(out.end(), part.begin(), part.end());
  }
  return all_to_all(std::span<const T>(out), counts);
}

}  // namespace scree
