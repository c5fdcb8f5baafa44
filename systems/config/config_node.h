#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace flinch {

/// A YAML value, with the lines on which everything stands. An alias is the very node of its anchor.
struct ConfigNode {
  enum class Kind { empty, scalar, list, mapping };

  struct Entry {
    std::string key;
    int line = 0;
    std::shared_ptr<const ConfigNode> value;
  };

  Kind kind = Kind::empty;
  std::shared_ptr<const std::string> file;  ///< In which it stands; null: in none.
  int line = 1;  ///< On which it begins, counted from 1; 0: what `file` names has no lines.

  std::string scalar;
  bool quoted = false;  ///< The scalar stood in quotes, so that it is text whatever it looks like.

  std::vector<std::shared_ptr<const ConfigNode>> items;  ///< Of a list.
  std::vector<Entry> entries;                            ///< Of a mapping, in order; a key may come twice.
};

/// The one YAML document in `text`; an empty node if there is none. Throws SetupError with `file`, line and
/// column where the text is not YAML, holds several documents, an alias inside its own anchor, or a key that
/// is no word.
std::shared_ptr<const ConfigNode> parse_yaml(std::string_view text, const std::string& file);

}  // namespace flinch
