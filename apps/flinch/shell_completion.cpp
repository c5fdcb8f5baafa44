#include "apps/flinch/shell_completion.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>

#include "apps/flinch/shell_word.h"

namespace flinch {
namespace {

/// A verb, by the words that lead to it: "calibrate thresholds".
struct CompletedVerb {
  std::string path;
  const CLI::App* app;
};

void add_verbs(const CLI::App& app, const std::string& path, std::vector<CompletedVerb>& verbs) {
  verbs.push_back({path, &app});
  for (const CLI::App* const verb : app.get_subcommands([](const CLI::App*) { return true; }))
    add_verbs(*verb, path.empty() ? verb->get_name() : path + " " + verb->get_name(), verbs);
}

std::vector<CompletedVerb> verbs_of(const CLI::App& app) {
  std::vector<CompletedVerb> verbs;
  add_verbs(app, "", verbs);
  return verbs;
}

/// "--out", "--json" and the verbs below.
std::vector<std::string> words_of(const CLI::App& verb) {
  std::vector<std::string> words;
  for (const CLI::App* const below : verb.get_subcommands([](const CLI::App*) { return true; }))
    words.push_back(below->get_name());
  for (const CLI::Option* const option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
    for (const std::string& name : option->get_snames()) words.push_back("-" + name);
  }
  return words;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// The first sentence of a help text, in one line.
std::string first_sentence(std::string text) {
  text = text.substr(0, text.find('\n'));
  return text.substr(0, text.find(". "));
}

std::string for_bash(const CLI::App& app) {
  std::string cases;
  for (const CompletedVerb& verb : verbs_of(app))
    cases += fmt::format("    {}) words={} ;;\n", verb.path.empty() ? "''" : shell_word(verb.path),
                         shell_word(joined(words_of(*verb.app))));
  return fmt::format(R"(# Completion of flinch for bash, by 'flinch completion bash'.
_flinch() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} path='' words='' each
  for each in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case $each in
      -*) ;;
      *) case " $(_flinch_words "$path") " in *" $each "*) path=${{path:+$path }}$each ;; esac ;;
    esac
  done
  words=$(_flinch_words "$path")
  COMPREPLY=($(compgen -W "$words" -- "$word"))
  [[ $word == -* || (-z $path && ${{#COMPREPLY[@]}} -gt 0) ]] || COMPREPLY+=($(compgen -f -- "$word"))
}}
_flinch_words() {{
  local words=''
  case $1 in
{}  esac
  echo "$words"
}}
complete -o filenames -F _flinch flinch
)",
                     cases);
}

std::string for_fish(const CLI::App& app) {
  std::string text = "# Completion of flinch for fish, by 'flinch completion fish'.\n";
  for (const CompletedVerb& verb : verbs_of(app)) {
    std::string condition = "__fish_use_subcommand";
    if (!verb.path.empty())
      condition = "__fish_seen_subcommand_from " + verb.path.substr(verb.path.rfind(' ') + 1);
    for (const CLI::App* const below : verb.app->get_subcommands([](const CLI::App*) { return true; }))
      text += fmt::format("complete -c flinch -n {} -a {} -d {}\n", shell_word(condition), below->get_name(),
                          shell_word(first_sentence(below->get_description())));
    for (const CLI::Option* const option : verb.app->get_options())
      for (const std::string& name : option->get_lnames())
        text += fmt::format("complete -c flinch -n {} -l {}{} -d {}\n", shell_word(condition), name,
                            option->get_items_expected_max() > 0 ? " -r" : "",
                            shell_word(first_sentence(option->get_description())));
  }
  return text;
}

}  // namespace

std::vector<std::string> completed_shells() { return {"bash", "fish", "zsh"}; }

std::string completion_for(const std::string& shell, const CLI::App& app) {
  if (shell == "fish") return for_fish(app);
  const std::string script = for_bash(app);
  return shell == "bash" ? script : "#compdef flinch\nautoload -U +X bashcompinit && bashcompinit\n" + script;
}

}  // namespace flinch
