#include "import/mapping_text.h"

#include <algorithm>

namespace flinch {

std::string mapping_text(const MappingGuess& guess, const std::filesystem::path& robot) {
  std::string text = "# Guessed by flinch import --guess; check it.\n";
  // A name out of the log may hold a line break, which would end the comment.
  const auto add_comment = [&text](const std::string& begin, std::string sentence) {
    std::replace_if(
        sentence.begin(), sentence.end(), [](char letter) { return letter == '\n' || letter == '\r'; }, ' ');
    text += begin + sentence + "\n";
  };
  for (const std::string& reason : guess.reasons) add_comment("# ", reason);
  for (const std::string& question : guess.questions) add_comment("# ? ", question);
  const LogMapping& mapping = guess.mapping;
  const auto quoted = [](const std::string& name) {
    std::string safe;
    for (const char letter : name)
      safe += letter == '"' || letter == '\\' ? std::string("\\") + letter
              : letter == '\n'                ? std::string("\\n")
                                              : std::string(1, letter);
    return "\"" + safe + "\"";
  };
  text += "log: " + quoted(mapping.log.string()) + "\nrobot: " + quoted(robot.string()) +
          "\ntime: {column: " + quoted(mapping.clock.column) + ", unit: " + guess.clock_unit;
  if (!mapping.clock.second_column.empty())
    text += ", second_column: " + quoted(mapping.clock.second_column) +
            ", second_unit: " + (mapping.clock.second_unit == ClockUnit::us ? "us" : "ns");
  text += "}\ncolumns:\n";
  for (std::size_t i = 0; i < mapping.columns.size(); ++i) {
    const MappedColumn& column = mapping.columns[i];
    text += "  - {column: " + quoted(column.column) + ", signal: " + column.signal +
            ", entry: " + std::to_string(column.entry) + ", unit: " + quoted(guess.units[i]) +
            (column.scale < 0.0 ? ", negate: true" : "") + "}\n";
  }
  return text;
}

}  // namespace flinch
