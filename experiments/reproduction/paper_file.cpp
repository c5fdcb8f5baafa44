#include "experiments/reproduction/paper_file.h"

#include <algorithm>

#include "experiments/reproduction/figure_path.h"
#include "systems/config/config_reader.h"
#include "systems/config/file_kind.h"

namespace flinch {
namespace {

void check_path(ConfigReader& reader, const char* key, const std::string& path) {
  const std::string problem = path.empty() ? "" : problem_with_path(path);
  if (!problem.empty()) reader.problem(key, problem);
}

std::vector<std::string> split(const std::string& text, const std::string& at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + at.size();
  }
  return parts;
}

/// The words of a command as a shell has them, as far as blanks and quotes go.
std::vector<std::string> shell_words(const std::string& command) {
  std::vector<std::string> words;
  char quote = 0;
  bool in_word = false;
  for (const char letter : command) {
    const bool ends = quote == 0 && (letter == ' ' || letter == '\t' || letter == '\n');
    if (!ends && !in_word) words.emplace_back();
    in_word = !ends;
    if (ends) continue;
    if (letter == quote) {
      quote = 0;
    } else if (quote == 0 && (letter == '\'' || letter == '"')) {
      quote = letter;
    } else {
      words.back() += letter;
    }
  }
  return words;
}

/// The same; those that name a file beside `folder` become its whole path.
std::vector<std::string> words_of(const std::string& command, const std::filesystem::path& folder) {
  std::vector<std::string> words = shell_words(command);
  for (std::string& word : words) {
    const std::filesystem::path file = folder / word;
    if (std::filesystem::is_regular_file(file))
      word = std::filesystem::absolute(file).lexically_normal().string();
  }
  return words;
}

RunSource read_run(ConfigReader& reader, const std::filesystem::path& folder) {
  using Kind = RunSource::Kind;
  RunSource run;
  const std::string_view kind = reader.one_of({"scenario", "campaign", "commands"});
  if (kind == "commands") {
    run.kind = Kind::commands;
    std::string text;
    reader.required().text(kind, text);
    for (const std::string& command : split(text, "&&")) {
      run.commands.push_back(words_of(command, folder));
      if (!text.empty() && run.commands.back().empty()) reader.problem(kind, "has a command without words");
    }
    return run;
  }
  if (kind == "campaign") run.kind = Kind::campaign;
  if (!kind.empty()) reader.required().file(kind, run.file);
  for (ConfigReader& value : reader.sections("set")) {
    std::string key, text;
    value.required().text("key", key);
    value.required().text("value", text);
    run.set.push_back(key + "=" + text);
  }
  if (run.kind == Kind::campaign && reader.has("runs")) {
    int runs = 1;
    reader.integer("runs", runs, 1);
    run.runs = static_cast<std::size_t>(runs);
  }
  return run;
}

/// A term: 'motion.pose[0]', or 'motion.pose[0] - reference.pose[0]'.
std::optional<SignalCurve::Term> term_of(const std::string& text) {
  const std::vector<std::string> numbers = split(text, " - ");
  const std::optional<SignalNumber> of = signal_number(numbers.front());
  if (!of || numbers.size() > 2) return std::nullopt;
  if (numbers.size() == 1) return SignalCurve::Term{*of, std::nullopt};
  const std::optional<SignalNumber> less = signal_number(numbers.back());
  return less ? std::optional(SignalCurve::Term{*of, less}) : std::nullopt;
}

constexpr const char* not_a_number = "is no recorded number, such as 'motion.pose[0]'";

void read_terms(ConfigReader& reader, std::string_view key, SignalCurve& curve) {
  std::string text;
  reader.required().text(key, text);
  if (text.empty()) return;
  for (const std::string& each : split(text, ", ")) {
    const std::optional<SignalCurve::Term> term = term_of(each);
    if (term) {
      curve.terms.push_back(*term);
    } else {
      reader.problem(
          key, "has '" + each + "', which " + not_a_number + " or 'motion.pose[0] - reference.pose[0]'");
    }
  }
  if (!curve.is_length && curve.terms.size() > 1)
    reader.problem(key, "has several numbers; for the length of their vector write 'length_of'");
}

SignalCurve read_curve(ConfigReader& reader) {
  SignalCurve curve;
  const std::string_view kind = reader.one_of({"of", "length_of"});
  curve.is_length = kind == "length_of";
  if (!kind.empty()) read_terms(reader, kind, curve);
  reader.number("times", unit::none, curve.times);
  reader.number("less_earlier", unit::s, curve.less_earlier, not_negative);
  reader.flag("since_contact", curve.since_contact);
  reader.number("from", unit::s, curve.from);
  reader.number("to", unit::s, curve.to);
  std::string where;
  reader.text("where", where);
  curve.where = signal_number(where);
  if (!where.empty() && !curve.where) reader.problem("where", not_a_number);
  return curve;
}

CurveStatistic read_statistic(ConfigReader& reader) {
  using Kind = CurveStatistic::Kind;
  CurveStatistic statistic;
  const auto kind = [](Kind each) { return std::pair<std::string_view, Kind>(word(each), each); };
  reader.choice("take", statistic.kind,
                {kind(Kind::largest), kind(Kind::least), kind(Kind::last), kind(Kind::mean), kind(Kind::rms),
                 kind(Kind::longest_below), kind(Kind::longest_above), kind(Kind::slope),
                 kind(Kind::share_of_range), kind(Kind::signal_to_noise)});
  if (needs_level(statistic.kind)) reader.required().number("level", unit::none, statistic.level);
  if (needs_other(statistic.kind)) {
    ConfigReader other = reader.required().section("other");
    statistic.other = read_curve(other);
  }
  return statistic;
}

std::optional<FigureSource> read_source(ConfigReader& entry, const char* name,
                                        const std::filesystem::path& folder) {
  if (!entry.has(name)) return std::nullopt;
  FigureSource source;
  ConfigReader reader = entry.section(name);
  source.run = read_run(reader, folder);
  reader.number("times", unit::none, source.times);
  if (source.run.kind == RunSource::Kind::scenario && reader.has("curve")) {
    ConfigReader curve = reader.section("curve");
    source.curve = read_curve(curve);
    source.statistic = read_statistic(reader);
    return source;
  }
  reader.required().text("figure", source.figure);
  reader.text("less", source.less);
  reader.text("per", source.per);
  check_path(reader, "figure", source.figure);
  check_path(reader, "less", source.less);
  check_path(reader, "per", source.per);
  return source;
}

PaperFigure read_figure(ConfigReader& entry, const std::filesystem::path& folder) {
  PaperFigure figure;
  entry.required().text("id", figure.id);
  entry.required().text("source", figure.source);
  entry.required().text("title", figure.title);
  entry.text("unit", figure.unit);
  entry.required().number("paper", unit::none, figure.paper);
  entry.choice("better", figure.better,
               {{"neither", PaperFigure::Better::neither},
                {"lower", PaperFigure::Better::lower},
                {"higher", PaperFigure::Better::higher}});
  entry.number("within", unit::none, figure.within, between(1.0, 1e6));
  entry.text("reason", figure.reason);
  figure.as_printed = read_source(entry, "as_printed", folder);
  figure.ours = read_source(entry, "ours", folder);
  if (!figure.as_printed && !figure.ours) entry.problem("", "has neither 'as_printed' nor 'ours'");
  return figure;
}

PictureLine read_line(ConfigReader& entry, const std::filesystem::path& folder) {
  PictureLine line;
  entry.text("name", line.name);
  line.run = read_run(entry, folder);
  if (line.run.kind != RunSource::Kind::scenario)
    entry.problem("", "is no run of a scenario; lines are drawn of one");
  ConfigReader curve = entry.required().section("curve");
  line.curve = read_curve(curve);
  if (entry.has("over")) {
    ConfigReader over = entry.section("over");
    line.over = read_curve(over);
  }
  return line;
}

PictureDots read_dots(ConfigReader& entry, const std::filesystem::path& folder) {
  PictureDots dots;
  entry.text("name", dots.name);
  dots.run = read_run(entry, folder);
  if (dots.run.kind != RunSource::Kind::campaign)
    entry.problem("", "is no campaign; dots are the runs of one");
  entry.required().text("x", dots.x);
  entry.required().text("y", dots.y);
  entry.text("x_less", dots.x_less);
  entry.number("x_times", unit::none, dots.x_times);
  entry.number("y_times", unit::none, dots.y_times);
  entry.text("body", dots.of);
  entry.flag("with_line", dots.with_line);
  return dots;
}

PictureMatrix read_matrix(ConfigReader& reader, const std::filesystem::path& folder) {
  PictureMatrix matrix;
  matrix.run = read_run(reader, folder);
  if (matrix.run.kind != RunSource::Kind::commands)
    reader.problem("", "is of no 'commands', which print one");
  reader.required().text("key", matrix.key);
  return matrix;
}

PictureMark read_mark(ConfigReader& entry) {
  PictureMark mark;
  entry.text("name", mark.name);
  const std::string_view axis = entry.one_of({"x", "y"});
  mark.upright = axis == "x";
  if (!axis.empty()) entry.required().number(axis, unit::none, mark.at);
  return mark;
}

PaperPicture read_picture(ConfigReader& entry, const std::filesystem::path& folder) {
  PaperPicture picture;
  entry.required().text("id", picture.id);
  entry.required().text("source", picture.source);
  entry.required().text("title", picture.title);
  entry.text("note", picture.note);
  for (ConfigReader& line : entry.sections("lines")) picture.lines.push_back(read_line(line, folder));
  for (ConfigReader& dots : entry.sections("dots")) picture.dots.push_back(read_dots(dots, folder));
  for (ConfigReader& mark : entry.sections("marks")) picture.marks.push_back(read_mark(mark));
  if (entry.has("matrix")) {
    ConfigReader matrix = entry.section("matrix");
    picture.matrix = read_matrix(matrix, folder);
  } else {
    entry.required().text("x", picture.x_title);
    entry.required().text("y", picture.y_title);
  }
  if (picture.lines.empty() && picture.dots.empty() && !picture.matrix)
    entry.problem("", "has neither 'lines' nor 'dots' nor a 'matrix'");
  return picture;
}

/// `what`: of which sort they are, in words.
template <class Each>
void check_id(ConfigReader& entry, const std::vector<Each>& all, const std::string& what) {
  const std::string& id = all.back().id;
  const auto same = [&id](const Each& other) { return other.id == id; };
  if (!id.empty() && std::count_if(all.begin(), all.end(), same) > 1)
    entry.problem("id", "is '" + id + "', as that of another " + what);
}

}  // namespace

PaperFigures read_paper_file(const std::filesystem::path& file) {
  ConfigReader reader = ConfigReader::open(file);
  require_kind(reader, FileKind::figures);
  const std::filesystem::path folder = file.parent_path();
  PaperFigures all;
  for (ConfigReader& entry : reader.sections("figures")) {
    all.figures.push_back(read_figure(entry, folder));
    check_id(entry, all.figures, "figure");
  }
  for (ConfigReader& entry : reader.sections("pictures")) {
    all.pictures.push_back(read_picture(entry, folder));
    check_id(entry, all.pictures, "picture");
  }
  if (reader.good() && all.figures.empty() && all.pictures.empty())
    reader.problem("", "has neither 'figures' nor 'pictures'");
  reader.finish();
  return all;
}

}  // namespace flinch
