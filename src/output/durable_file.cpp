#include "output/durable_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/error.hpp"
#include "base/index.hpp"

namespace scree {

namespace {

[[noreturn]] void fail(const std::string& path, const char* action, int error) {
  throw IoError(fmt::format("{}: cannot {}: {}", path, action, std::strerror(error)));
}

[[noreturn]] void fail_reading(const std::string& path, int error) {
  throw IoError(fmt::format("{}: cannot be read: {}", path, std::strerror(error)));
}

// Creates a new file in place of any existing one; a link is not followed.
int create(const std::string& path) {
  unlink(path.c_str());
  return open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
}

// Writes, syncs and closes. Returns the system's error number, 0 on success.
int write_and_sync(int file, const std::string& text) {
  if (file < 0) return errno;
  int error = 0;
  for (std::size_t done = 0; done < text.size() && error == 0;) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    if (written >= 0) {
      done += as_size(written);
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  if (error == 0 && fsync(file) != 0) error = errno;
  if (close(file) != 0 && error == 0) error = errno;
  return error;
}

}  // namespace

std::string read_text_file(const std::string& path) {
  // O_NONBLOCK: opening a pipe would wait for a writer.
  const int file = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) fail_reading(path, errno);
  std::string text;
  std::array<char, 4096> piece;
  ssize_t count = 1;
  int error = 0;
  while (count != 0 && error == 0) {
    count = read(file, piece.data(), piece.size());
    if (count > 0) text.append(piece.data(), as_size(count));
    if (count < 0 && errno != EINTR) error = errno;
  }
  close(file);
  if (error != 0) fail_reading(path, error);
  return text;
}

// Used in place of std::filesystem::copy_file(), which does not report the system's reason.
void copy_file(const std::string& from, const std::string& to) {
  const int in = open(from.c_str(), O_RDONLY | O_CLOEXEC);
  if (in < 0) fail(from, "open", errno);
  const int out = create(to);
  int error = out < 0 ? errno : 0;
  for (ssize_t copied = 1; error == 0 && copied != 0;) {
    copied = sendfile(out, in, nullptr, std::size_t{1} << 30);
    if (copied < 0 && errno != EINTR) error = errno;
  }
  close(in);
  if (out >= 0 && close(out) != 0 && error == 0) error = errno;
  if (error != 0) fail(to, ("copy " + from + " to it").c_str(), error);
}

// Uses fallocate(), because posix_fallocate() writes into every block if the file system cannot reserve.
bool reserve_file(const std::string& path) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) fail(path, "open", errno);
  struct stat status {};
  int error = fstat(file, &status) == 0 ? 0 : errno;
  while (error == 0 && status.st_size > 0 && fallocate(file, 0, 0, status.st_size) != 0) {
    if (errno != EINTR) error = errno;
  }
  close(file);
  const bool can = error != EOPNOTSUPP && error != ENOSYS;
  if (can && error != 0) fail(path, "reserve its disk space", error);
  return can;
}

void sync_file(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail(path, "open", errno);
  const int error = fdatasync(file) == 0 ? 0 : errno;
  close(file);
  if (error != 0) fail(path, "sync", error);
}

void sync_folder_of(const std::string& path) {
  const std::string parent = std::filesystem::path(path).parent_path().string();
  const std::string folder = parent.empty() ? "." : parent;
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) fail(folder, "open", errno);
  const int error = fsync(file) == 0 ? 0 : errno;
  close(file);
  // Some file systems cannot sync a folder; they sync its entries with the file.
  if (error != 0 && error != EINVAL) fail(folder, "sync", error);
}

void replace_file(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) fail(to, "replace", errno);
  sync_folder_of(to);
}

bool exchange_files(const std::string& hidden, const std::string& path, const std::string& aside) {
  if (renameat2(AT_FDCWD, hidden.c_str(), AT_FDCWD, path.c_str(), RENAME_EXCHANGE) == 0) return true;
  // For file systems that cannot exchange names: a second name keeps the visible file alive during the
  // rename. Without hard links or without a visible file, the previous content is lost.
  unlink(aside.c_str());
  const bool has_second_name = link(path.c_str(), aside.c_str()) == 0;
  if (std::rename(hidden.c_str(), path.c_str()) != 0) fail(path, "replace", errno);
  return has_second_name && std::rename(aside.c_str(), hidden.c_str()) == 0;
}

void write_text_file(const std::string& path, const std::string& text) {
  const std::string temporary_path = path + ".tmp";
  if (const int error = write_and_sync(create(temporary_path), text)) {
    std::remove(temporary_path.c_str());
    fail(temporary_path, "write", error);
  }
  replace_file(temporary_path, path);
}

void append_text_file(const std::string& path, const std::string& text) {
  const int file = open(path.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC);
  if (const int error = write_and_sync(file, text)) fail(path, "write", error);
}

}  // namespace scree
