#include "output/file_seal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <vector>

#include "base/bit_hash.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "model/data/id_range.hpp"
#include "output/durable_file.hpp"

namespace scree {

namespace {

constexpr std::int64_t kPieceBytes = std::int64_t{1} << 20;

class ReadFile {
 public:
  explicit ReadFile(const std::string& path) : path_(path), file_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    struct stat status {};
    if (file_ < 0) fail("open", errno);
    if (fstat(file_, &status) != 0) {
      const int error = errno;
      close(file_);
      fail("open", error);
    }
    size_ = status.st_size;
  }
  ~ReadFile() { close(file_); }
  ReadFile(const ReadFile&) = delete;
  ReadFile& operator=(const ReadFile&) = delete;

  std::int64_t size() const { return size_; }
  void read(std::int64_t from, std::int64_t count, char* to) const {
    while (count > 0) {
      const ssize_t done = pread(file_, to, as_size(count), from);
      if (done < 0 && errno == EINTR) continue;
      if (done == 0) errno = EIO;  // the file is shorter than before
      if (done <= 0) fail("read", errno);
      from += done, to += done, count -= done;
    }
  }

 private:
  [[noreturn]] void fail(const char* action, int error) const {
    throw IoError(fmt::format("{}: cannot {}: {}", path_, action, std::strerror(error)));
  }
  std::string path_;
  int file_;
  std::int64_t size_ = 0;
};

std::string seal_line(std::uint64_t checksum) { return fmt::format("\nchecksum {:016x}\n", checksum); }

const std::int64_t kLineBytes = std::ssize(seal_line(0));

// Checksum of the first `bytes` bytes: the sum of the hashes of pieces, independent of the number of ranks.
std::uint64_t checksum(const ReadFile& file, std::int64_t bytes, const Ranks& ranks) {
  std::uint64_t sum = 0;
  ranks.collectively([&] {
    std::vector<char> piece(as_size(std::min(bytes, kPieceBytes)));
    const IdRange own = id_range((bytes + kPieceBytes - 1) / kPieceBytes, ranks.rank(), ranks.size());
    for (std::int64_t k = own.first; k < own.last; ++k) {
      const std::int64_t from = k * kPieceBytes, count = std::min(kPieceBytes, bytes - from);
      file.read(from, count, piece.data());
      BitHash hash;
      hash.add(k), hash.add(count), hash.add(piece.data(), as_size(count));
      sum += hash.hash();
    }
  });
  return static_cast<std::uint64_t>(ranks.sum(static_cast<std::int64_t>(sum)));
}

}  // namespace

void seal_file(const std::string& path, const Ranks& ranks) {
  std::optional<ReadFile> file;
  ranks.collectively([&] { file.emplace(path); });
  const std::uint64_t sum = checksum(*file, file->size(), ranks);
  ranks.on_root([&] { append_text_file(path, seal_line(sum)); });
}

Seal check_seal(const std::string& path, const Ranks& ranks) {
  std::optional<ReadFile> file;
  std::string line(as_size(kLineBytes), ' ');
  ranks.collectively([&] {
    file.emplace(path);
    if (file->size() >= kLineBytes) file->read(file->size() - kLineBytes, kLineBytes, line.data());
  });
  const auto words = seal_line(0).find('0');  // the text before the digits
  if (ranks.any(line.compare(0, words, seal_line(0), 0, words) != 0 || line.back() != '\n'))
    return Seal::none;
  const std::uint64_t sum = checksum(*file, file->size() - kLineBytes, ranks);
  return ranks.any(line != seal_line(sum)) ? Seal::broken : Seal::intact;
}

}  // namespace scree
