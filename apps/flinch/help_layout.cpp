#include "apps/flinch/help_layout.h"

#include <sstream>

namespace flinch {
namespace {

constexpr std::size_t columns = 80;
constexpr std::size_t of_names = 30;  // columns before descriptions

}  // namespace

HelpLayout::HelpLayout() { column_width(of_names); }

std::string HelpLayout::make_option(const CLI::Option* option, bool is_positional) const {
  return row(make_option_name(option, is_positional) + make_option_opts(option), make_option_desc(option));
}

std::string HelpLayout::make_subcommand(const CLI::App* verb) const {
  return row(verb->get_name(), verb->get_description());
}

std::string HelpLayout::make_description(const CLI::App* app) const {
  return wrapped(app->get_description(), columns, 0) + "\n";
}

std::string HelpLayout::row(const std::string& name, const std::string& description) const {
  std::string text = "  " + name;
  if (text.size() + 1 > of_names)
    text += "\n" + std::string(of_names, ' ');
  else
    text.resize(of_names, ' ');
  return text + wrapped(description, columns - of_names, of_names) + "\n";
}

std::string wrapped(const std::string& text, std::size_t width, std::size_t indent) {
  std::istringstream words(text);
  std::string lines, word;
  std::size_t at = 0;
  while (words >> word) {
    if (at > 0 && at + 1 + word.size() > width) {
      lines += "\n" + std::string(indent, ' ');
      at = 0;
    } else if (at > 0) {
      lines += " ";
      ++at;
    }
    lines += word;
    at += word.size();
  }
  return lines;
}

}  // namespace flinch
