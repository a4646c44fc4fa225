#include "support/measured.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>

#include "base/version.hpp"

namespace scree {

namespace {

struct Row {
  std::string unit, machine, backend;
  Real least, most, at_least, at_most;
  std::optional<Real> median = {};
};

std::string quoted(const std::string& text) {
  std::string out;
  for (const char letter : text) out += letter == '"' ? "\"\"" : std::string(1, letter);
  return '"' + out + '"';
}

// Empty where there is no bound.
std::string number(Real value, int digits) {
  if (std::isinf(value)) return "";
  std::ostringstream out;
  out.precision(digits);
  out << value;
  return out.str();
}

// The value that counts: the largest error, or the least of what must be large; infinite where both ends do.
Real value_of(const Row& row) {
  if (row.median) return *row.median;
  const bool below = !std::isinf(row.at_most), above = !std::isinf(row.at_least);
  if (below != above) return above ? row.least : row.most;
  return row.least == row.most ? row.most : kInfinity;
}

class Record {
 public:
  Record() {
    const char *folder = std::getenv("SCREE_MEASURED"), *backend = std::getenv("SCREE_TEST_BACKEND");
    if (folder != nullptr) folder_ = folder;
    if (backend != nullptr) backend_ = backend;
    command_ = program_invocation_short_name;
    std::ifstream words("/proc/self/cmdline");
    std::string word;
    std::getline(words, word, '\0');
    while (std::getline(words, word, '\0')) command_ += ' ', command_.append(word, word.rfind('/') + 1);
  }
  Record(const Record&) = delete;
  Record& operator=(const Record&) = delete;
  ~Record() {
    if (rows_.empty()) return;
    try {
      write();
    } catch (const std::exception& error) {
      std::cerr << "SCREE_MEASURED: " << error.what() << '\n';
    }
  }

  void note(const std::string& key, const std::string& unit, const Bounded& number) {
    if (folder_.empty()) return;
    const auto [found, is_new] = rows_.try_emplace(
        key, Row{unit, machine_, backend_, number.value, number.value, number.at_least, number.at_most});
    Row& row = found->second;
    if (is_new) return;
    row.least = std::min(row.least, number.value), row.most = std::max(row.most, number.value);
    // Keeps the demand that all values satisfy.
    row.at_least = std::min(row.at_least, number.at_least);
    row.at_most = std::max(row.at_most, number.at_most);
  }
  void note_samples(const std::string& key, const Row& row) {
    if (folder_.empty()) return;
    Row& kept = rows_.insert_or_assign(key, row).first->second;
    kept.machine = machine_, kept.backend = backend_;
  }
  void measured_on_ranks(int ranks) { command_ = "mpirun -n " + std::to_string(ranks) + " " + command_; }
  void measured_on_gpu(const std::string& name) { machine_ = name, backend_ = "cuda"; }

 private:
  // Written under another name first, so that the file is complete whenever it exists.
  void write() const {
    std::filesystem::create_directories(folder_);
    std::string name = command_ + (backend_ == "cpu" ? "" : "-" + backend_);
    for (char& letter : name)
      if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-') letter = '_';
    const std::filesystem::path path = folder_ / (name + ".csv");
    std::filesystem::path part = path;
    part += ".part";
    std::ofstream file(part);
    file.exceptions(std::ios::failbit | std::ios::badbit);
    std::array<char, 16> date{};
    const std::time_t now = std::time(nullptr);
    std::strftime(date.data(), date.size(), "%Y-%m-%d", std::gmtime(&now));
    file << "key,value,unit,least,most,at_least,at_most,commit,machine,backend,date,command\n";
    for (const auto& [key, row] : rows_)
      file << quoted(key) << ',' << number(value_of(row), 4) << ',' << quoted(row.unit) << ','
           << number(row.least, 4) << ',' << number(row.most, 4) << ',' << number(row.at_least, 6) << ','
           << number(row.at_most, 6) << ',' << commit() << ',' << quoted(row.machine) << ',' << row.backend
           << ',' << date.data() << ',' << quoted(command_) << '\n';
    file.close();
    std::filesystem::rename(part, path);
  }

  std::filesystem::path folder_;
  std::string command_, backend_ = "cpu", machine_ = processor_name();
  std::map<std::string, Row> rows_;
};

Record& record() {
  static Record one;
  return one;
}

}  // namespace

void note(const std::string& key, const std::string& unit, const Bounded& number) {
  record().note(key, unit, number);
}

void note_samples(const std::string& key, const std::string& unit, Real median, Real least, Real most) {
  record().note_samples(key, Row{unit, "", "", least, most, -kInfinity, kInfinity, median});
}

void measured_on_gpu(const std::string& name) { record().measured_on_gpu(name); }

void measured_on_ranks(int ranks) { record().measured_on_ranks(ranks); }

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace scree
