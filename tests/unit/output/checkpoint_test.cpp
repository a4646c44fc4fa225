#include "output/checkpoint.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "base/error.hpp"
#include "output/file_seal.hpp"
#include "scratch.hpp"
#include "support/bits.hpp"
#include "support/catch.hpp"

using namespace scree;

namespace {

// Values that a conversion to decimals or a comparison would change.
Checkpoint awkward_checkpoint() {
  Checkpoint checkpoint;
  checkpoint.reals["particles/velocity"] = {0.1,
                                            -0.0,
                                            std::bit_cast<double>(std::uint64_t{0x7ff80000deadbeef}),
                                            std::bit_cast<double>(std::uint64_t{0xfff0000000000001}),
                                            -INFINITY,
                                            std::numeric_limits<double>::denorm_min()};
  checkpoint.reals["bodies/multipliers"] = {};
  checkpoint.reals["time"] = {1.0 / 3};
  checkpoint.integers["particles/global_id"] = {0, -1, std::numeric_limits<std::int64_t>::min()};
  checkpoint.integers["none"] = {};
  checkpoint.texts["deck"] = "title = \"ü\"\n";
  checkpoint.texts["empty"] = "";
  checkpoint.texts["long"] = std::string(200000, 'x');
  return checkpoint;
}

}  // namespace

TEST_CASE("a checkpoint returns bit for bit") {
  ScratchDirectory scratch;
  const Checkpoint written = awkward_checkpoint();
  write_checkpoint(scratch / "c.h5", written);
  write_checkpoint(scratch / "c.h5", written);  // overwrites the first one
  const Checkpoint read = read_checkpoint(scratch / "c.h5");
  CHECK(read.reals.size() == written.reals.size());
  for (const auto& [name, values] : written.reals) CHECK(same_bits(read.real_array(name), values));
  CHECK(read.integers == written.integers);
  CHECK(read.texts == written.texts);
  CHECK(read.path == scratch / "c.h5");
  CHECK(!std::filesystem::exists(scratch / "c.h5.tmp"));
}

TEST_CASE("missing datasets of a checkpoint are named") {
  ScratchDirectory scratch;
  write_checkpoint(scratch / "c.h5", awkward_checkpoint());
  const Checkpoint checkpoint = read_checkpoint(scratch / "c.h5");
  CHECK_THROWS_AS(checkpoint.real_array("none"), IoError);
  CHECK_THROWS_AS(checkpoint.integer_array("time"), IoError);
  try {
    checkpoint.text("commit");
    FAIL("no exception");
  } catch (const IoError& error) {
    CHECK(std::string(error.what()) == (scratch / "c.h5") + ": the checkpoint lacks \"commit\"");
  }
}

TEST_CASE("a truncated checkpoint is refused at every length") {
  ScratchDirectory scratch;
  write_checkpoint(scratch / "c.h5", awkward_checkpoint());
  const auto size = std::filesystem::file_size(scratch / "c.h5");
  for (std::uintmax_t length = 0; length < size; length += 1 + size / 50) {
    std::filesystem::copy_file(scratch / "c.h5", scratch / "cut.h5",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(scratch / "cut.h5", length);
    CAPTURE(length);
    CHECK_THROWS_AS(read_checkpoint(scratch / "cut.h5"), IoError);
  }
}

namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The message for a file with these bytes; "" if it is read.
std::string refusal(const std::string& bytes) {
  const ScratchDirectory scratch;
  std::ofstream(scratch / "c.h5", std::ios::binary) << bytes;
  try {
    read_checkpoint(scratch / "c.h5");
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a checkpoint in which bits have changed is refused, whichever they are") {
  const ScratchDirectory scratch;
  write_checkpoint(scratch / "c.h5", awkward_checkpoint());
  const std::string whole = bytes_of(scratch / "c.h5");
  REQUIRE(refusal(whole) == "");
  std::mt19937_64 random(7);
  for (const int flips : {1, 2, 64})
    for (int trial = 0; trial < 400; ++trial) {
      std::string bytes = whole;
      for (int k = 0; k < flips; ++k) bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
      CAPTURE(flips, trial);
      CHECK((bytes == whole || refusal(bytes) != ""));
    }
  for (std::size_t at = whole.size() - 40; at < whole.size(); ++at) {  // the seal itself
    std::string bytes = whole;
    bytes[at] ^= 1;
    CHECK(refusal(bytes).find("the checkpoint is damaged") != std::string::npos);
  }
}

TEST_CASE("a checkpoint that another program has changed is refused, and one of another version") {
  const ScratchDirectory scratch;
  write_checkpoint(scratch / "c.h5", awkward_checkpoint());
  const std::string sealed = bytes_of(scratch / "c.h5");
  {
    Hdf5File file(scratch / "c.h5", Hdf5Access::modify);
    file.write_array("/reals/more", std::vector<Real>{1});
    file.close();
  }
  CHECK(refusal(bytes_of(scratch / "c.h5")).find("the checkpoint is damaged") != std::string::npos);
  const std::string name = "scree checkpoint 5";
  for (const auto& [number, words] : {std::pair{'4', "of an older version"}, {'6', "of a newer version"}}) {
    std::string other = sealed.substr(0, sealed.size() - 26);  // older ones have no seal
    REQUIRE(other.find(name) != std::string::npos);
    other[other.find(name) + name.size() - 1] = number;
    CHECK(refusal(other).find(words) != std::string::npos);
  }
}

TEST_CASE("datasets outside the groups of a checkpoint are refused") {
  const ScratchDirectory scratch;
  write_checkpoint(scratch / "c.h5", awkward_checkpoint());
  {
    Hdf5File file(scratch / "c.h5", Hdf5Access::modify);
    file.write_array("/more/values", std::vector<Real>{1});
    file.close();
  }
  seal_file(scratch / "c.h5", {});
  CHECK(refusal(bytes_of(scratch / "c.h5")).find("\"more/values\" does not belong to a checkpoint") !=
        std::string::npos);
}

TEST_CASE("foreign and missing files are refused") {
  ScratchDirectory scratch;
  CHECK_THROWS_AS(read_checkpoint(scratch / "missing.h5"), IoError);
  CHECK_THROWS_AS(read_checkpoint(scratch.path()), IoError);
  std::ofstream(scratch / "text.h5") << "not HDF5\n";
  CHECK_THROWS_AS(read_checkpoint(scratch / "text.h5"), IoError);
  {
    Hdf5File file(scratch / "other.h5", Hdf5Access::create);
    file.write_array("/reals/time", std::vector<Real>{1});
    file.close();
  }
  CHECK_THROWS_AS(read_checkpoint(scratch / "other.h5"), IoError);
}

TEST_CASE("a checkpoint that cannot be written leaves the old one") {
  ScratchDirectory scratch;
  CHECK_THROWS_AS(write_checkpoint(scratch / "no_such_directory/c.h5", awkward_checkpoint()), IoError);
  Checkpoint checkpoint;
  checkpoint.reals["a"] = {1};
  write_checkpoint(scratch / "c.h5", checkpoint);
  checkpoint.reals["a/b"] = {2};  // a name cannot be both an array and a group
  CHECK_THROWS_AS(write_checkpoint(scratch / "c.h5", checkpoint), IoError);
  CHECK(read_checkpoint(scratch / "c.h5").real_array("a") == std::vector<Real>{1});
  CHECK(!std::filesystem::exists(scratch / "c.h5.tmp"));
}
