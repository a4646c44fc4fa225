// The resolved deck as text, and its fingerprint.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "deck/deck.hpp"
#include "deck/source_text.hpp"

namespace scree {

namespace {

bool is_table(const Key& key) { return key.type == ValueType::table || key.type == ValueType::tables; }

class Writer {
 public:
  // for_fingerprint: hashes of the contents of files in place of their paths, and without the keys that a
  // restart may change.
  Writer(int dimension, bool for_fingerprint) : dimension_(dimension), for_fingerprint_(for_fingerprint) {}

  void write_table(const DeckTable& table, const std::string& name);
  const std::string& result() const { return out_; }

 private:
  std::string value_text(const DeckTable& table, const Key& key) const;
  std::string inline_table(const DeckTable& table) const;
  std::string vector_text(Vec3 v) const;
  bool left_out(const std::string& table, const Key& key) const {
    const bool of_no_result =
        key.name == "title" || key.name == "output" || key.name == "stop" || key.name == "parallel";
    return for_fingerprint_ && ((table.empty() && of_no_result) || (table == "time" && key.name == "end"));
  }

  int dimension_;
  bool for_fingerprint_;
  std::string out_;
};

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += std::string("\\") + c;
    } else if (code < 0x20 || code == 0x7f) {
      result += fmt::format("\\u{:04x}", code);
    } else {
      result += c;
    }
  }
  return result + "\"";
}

template <class T, class ToText>
std::string list_text(const std::vector<T>& values, const ToText& to_text) {
  std::vector<std::string> texts;
  for (const T& value : values) texts.push_back(to_text(value));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

// 64-bit FNV-1a.
std::string hash_text(const std::string& text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return fmt::format("{:016x}", hash);
}

std::string file_hash(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream contents;
  if (!file || !(contents << file.rdbuf())) throw IoError(path + ": cannot be read, or is empty");
  return hash_text(contents.str());
}

std::string Writer::vector_text(Vec3 v) const {
  std::vector<Real> numbers{v.x, v.y};
  if (dimension_ == 3) numbers.push_back(v.z);
  return list_text(numbers, number_text);
}

std::string Writer::inline_table(const DeckTable& table) const {
  std::vector<std::string> texts;
  for (const Key& key : table.keys().keys) {
    if (table.has(key.name)) texts.push_back(key.name + " = " + value_text(table, key));
  }
  return fmt::format("{{ {} }}", fmt::join(texts, ", "));
}

std::string Writer::value_text(const DeckTable& table, const Key& key) const {
  const std::string& name = key.name;
  switch (key.type) {
    case ValueType::boolean:
      return table.boolean(name) ? "true" : "false";
    case ValueType::integer:
      return std::to_string(table.integer(name));
    case ValueType::real:
      return number_text(table.real(name));
    case ValueType::text:
    case ValueType::choice:
    case ValueType::name:
      return quoted(table.text(name));
    case ValueType::file:
      return quoted(for_fingerprint_ ? "contents " + file_hash(table.text(name)) : table.text(name));
    case ValueType::vector:
      return vector_text(table.vector(name));
    case ValueType::reals:
      return list_text(table.reals(name), number_text);
    case ValueType::integers:
      return list_text(table.integers(name), [](auto i) { return std::to_string(i); });
    case ValueType::texts:
      return list_text(table.texts(name), quoted);
    case ValueType::vectors:
      return list_text(table.vectors(name), [&](Vec3 v) { return vector_text(v); });
    case ValueType::quantity:
      return inline_table(table.table(name));
    case ValueType::table:
    case ValueType::tables:
      break;
  }
  return "";
}

// name: of the table's header in the text, without indices. Values are written before tables, as TOML
// requires.
void Writer::write_table(const DeckTable& table, const std::string& name) {
  const std::vector<Key>& keys = table.keys().keys;
  for (const Key& key : keys) {
    if (is_table(key) || !table.has(key.name) || left_out(name, key)) continue;
    const std::string& reason = table.values().at(key.name).reason;
    const bool explained = !for_fingerprint_ && !reason.empty();
    out_ += key.name + " = " + value_text(table, key) + (explained ? "  # chosen: " + reason : "") + "\n";
  }
  for (const Key& key : keys) {
    if (!is_table(key) || left_out(name, key)) continue;
    const std::string full = name.empty() ? key.name : name + "." + key.name;
    const bool single = key.type == ValueType::table;
    for (const DeckTable& entry : table.tables(key.name)) {
      out_ += single ? "\n[" + full + "]\n" : "\n[[" + full + "]]\n";
      write_table(entry, full);
    }
  }
}

std::string text_of(const DeckTable& root, bool for_fingerprint) {
  Writer writer(static_cast<int>(root.table("space").integer("dimension")), for_fingerprint);
  writer.write_table(root, "");
  return writer.result();
}

}  // namespace

std::string ChosenValue::text() const {
  const std::string shown = std::holds_alternative<Real>(value) ? number_text(std::get<Real>(value))
                                                                : quoted(std::get<std::string>(value));
  return table + "." + key + " = " + shown;
}

void DeckTable::take(const ChosenValue& chosen) {
  if (!chosen.table.empty()) {
    DeckTable& inner = std::get<std::vector<DeckTable>>(values_.at(chosen.table).data).front();
    return inner.take({"", chosen.key, chosen.value, chosen.reason});
  }
  DeckValue value{false, location_, "", false, chosen.reason};
  std::visit([&](const auto& of) { value.data = of; }, chosen.value);
  set(chosen.key, std::move(value));
  if (chosen.key != keys_->selector) return;
  for (const Key& key : keys_->keys)
    if (!key.kinds.empty() && std::ranges::find(key.kinds, text(chosen.key)) == key.kinds.end())
      values_.erase(key.name);
}

std::string Deck::resolved_text() const { return text_of(root, false); }

std::string Deck::fingerprint() const { return text_of(root, true); }

}  // namespace scree
