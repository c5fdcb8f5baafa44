#include "apps/flinch/man_page.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>

namespace flinch {
namespace {

/// As troff shows it: no minus that is a hyphen, no line that is a request.
std::string shown(const std::string& text) {
  std::string result;
  bool begins = true;
  for (const char letter : text) {
    if (begins && (letter == '.' || letter == '\'')) result += "\\&";
    if (letter == '\\') result += "\\e";
    if (letter == '-') result += "\\-";
    if (letter != '\\' && letter != '-') result += letter;
    begins = letter == '\n';
  }
  return result;
}

std::string option_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (option.get_positional())
    return fmt::format("\\fI{}\\fR", shown(type.empty() ? option.get_name() : type));
  std::string names;
  for (const std::string& name : option.get_lnames())
    names += (names.empty() ? "\\-\\-" : ", \\-\\-") + shown(name);
  for (const std::string& name : option.get_snames())
    names += (names.empty() ? "\\-" : ", \\-") + shown(name);
  const bool has_value = option.get_items_expected_max() > 0 && !type.empty();
  return fmt::format("\\fB{}\\fR", names) + (has_value ? fmt::format(" \\fI{}\\fR", shown(type)) : "");
}

void add_options(const CLI::App& verb, std::string& page) {
  for (const CLI::Option* const option : verb.get_options())
    page += fmt::format(".TP\n{}\n{}\n", option_name(*option), shown(option->get_description()));
}

void add_verb(const CLI::App& verb, const std::string& path, std::string& page) {
  page += fmt::format(".SS {} {}\n{}\n", path, verb.get_name(), shown(verb.get_description()));
  add_options(verb, page);
  for (const CLI::App* const below : verb.get_subcommands([](const CLI::App*) { return true; }))
    add_verb(*below, path + " " + verb.get_name(), page);
}

}  // namespace

std::string man_page(const CLI::App& app, const std::string& version) {
  std::string page = fmt::format(
      ".TH FLINCH 1 \"\" \"{}\"\n.SH NAME\nflinch \\- contact detection and reaction for parallel "
      "robots\n.SH "
      "SYNOPSIS\n\\fBflinch\\fR \\fIVERB\\fR [\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n{}\n.SH OPTIONS\n",
      shown(version), shown(app.get_description()));
  add_options(app, page);
  page += ".SH VERBS\n";
  for (const CLI::App* const verb : app.get_subcommands([](const CLI::App*) { return true; }))
    add_verb(*verb, app.get_name(), page);
  return page + ".SH EXIT STATUS\n" + shown(app.get_footer()) + "\n";
}

}  // namespace flinch
