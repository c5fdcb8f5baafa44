#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace flinch {

/// Help that fits a terminal of 80 columns.
class HelpLayout : public CLI::Formatter {
 public:
  HelpLayout();

  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* verb) const override;
  std::string make_description(const CLI::App* app) const override;

 private:
  std::string row(const std::string& name, const std::string& description) const;
};

/// Lines of at most `width` characters, broken at blanks; those after the first begin with `indent` of these.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);

}  // namespace flinch
