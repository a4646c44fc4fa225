#include "dem/reports/output_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "deck/suggestion.hpp"

namespace scree {

namespace {

const OutputField* find_field(std::string_view name) {
  const auto found =
      std::ranges::find_if(output_fields(), [&](const OutputField& f) { return name == f.head.name; });
  return found == output_fields().end() ? nullptr : &*found;
}

// Whether the table of particle_fields.hpp declares the field as constant.
bool is_constant(std::string_view field) {
#define SCREE_FIELD(name, type, unit, sentence, parts) \
  if (field == #name) return ((parts)&kConstant) != 0;
#define SCREE_PACKED(name, unit, sentence, parts, scalar, ...) \
  SCREE_FIELD(name, Vec3, unit, sentence, parts)               \
  SCREE_FIELD(scalar, Real, __VA_ARGS__)
  SCREE_PARTICLE_FIELDS(SCREE_FIELD, SCREE_PACKED)
#undef SCREE_FIELD
#undef SCREE_PACKED
  return false;
}

}  // namespace

const std::vector<OutputField>& output_fields() {
  static const std::vector<OutputField> fields = [] {
    std::vector<OutputField> all;
    for_each_output_field([&]<class Of>(const OutputHead& head, Of) {
      using Value = typename Of::Value;
      all.push_back({head, sizeof(Value), kReadsContacts<Of>, false, is_constant(head.name),
                     [](std::size_t n) -> OutputValues { return std::vector<Value>(n); }});
    });
    all.push_back({kGroupOutput, sizeof(int), false, true, true,
                   [](std::size_t n) -> OutputValues { return std::vector<int>(n); }});
    return all;
  }();
  return fields;
}

std::vector<OutputField> wanted_fields(const Output& output) {
  std::vector<OutputField> fields;
  for (const std::string& name : output.fields) {
    const OutputField* const field = find_field(name);
    if (field == nullptr) throw std::logic_error("no output field is named " + name);
    fields.push_back(*field);
  }
  return fields;
}

std::vector<OutputField> computed_fields(const Output& output) {
  std::vector<OutputField> computed = wanted_fields(output);
  std::erase_if(computed, [](const OutputField& field) { return field.of_id; });
  return computed;
}

void check_output_fields(const Deck& deck) {
  const DeckTable& table = deck.root.table("output");
  const std::vector<std::string>& names = table.texts("fields");
  std::vector<std::string> known;
  for (const OutputField& field : output_fields()) known.emplace_back(field.head.name);
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (find_field(*name) == nullptr)
      table.fail("fields", fmt::format("there is no output field \"{}\"{}", *name, suggestion(*name, known)));
    if (std::find(names.begin(), name, *name) != name)
      table.fail("fields", fmt::format("\"{}\" is repeated; every entry must be another one", *name));
  }
}

std::string output_fields_text() {
  std::string text =
      "Output fields (output.fields), besides the position and the global id, which every snapshot has:\n";
  for (const OutputField& field : output_fields())
    text += fmt::format("  {:<16} [{}] {}.\n", field.head.name, field.head.unit, field.head.description);
  return text;
}

std::string output_fields_markdown() {
  std::string text =
      "<a id=\"output_fields\"></a>\n\n## Output fields\n\nFor [`output.fields`](#output.fields), besides "
      "the "
      "position and the global id, which every snapshot has.\n\n| field | unit | what it is "
      "|\n|---|---|---|\n";
  for (const OutputField& field : output_fields())
    text += fmt::format("| `{}` | {} | {} |\n", field.head.name, field.head.unit, field.head.description);
  return text;
}

}  // namespace scree
