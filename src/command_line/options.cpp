#include "src/command_line/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <locale>
#include <sstream>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

namespace {

/// Of --help: where descriptions begin, and how wide they are, in a terminal of 80 characters.
constexpr std::size_t name_columns = 26, description_columns = 54;

/// In lines of at most `columns` characters, broken between words; CLI11 indents those after the first.
std::string wrapped(const std::string& text, std::size_t columns) {
  std::string lines, word;
  std::size_t used = 0;
  for (std::istringstream words(text); words >> word; used += word.size()) {
    if (used > 0 && used + 1 + word.size() > columns) {
      lines += '\n';
      used = 0;
    } else if (used > 0) {
      lines += ' ';
      ++used;
    }
    lines += word;
  }
  return lines;
}

/// What an option's values are is read from it afterwards.
bool any_value(const CLI::results_t&) { return true; }

/// Of CLI11's text, which begins with the name of the option.
std::string mismatch_text(const CLI::ArgumentMismatch& e) {
  const std::string text = e.what(), name = text.substr(0, text.find_first_of(": "));
  return (name.rfind('-', 0) == 0 ? name : "--" + name) +
         (text.find("flag override") == std::string::npos ? ": needs a value" : ": takes no value");
}

long long whole_number(const std::string& name, const std::string& value, long long lowest,
                       long long highest) {
  char* end = nullptr;
  errno = 0;
  const long long number = std::strtoll(value.c_str(), &end, 10);
  if (*end || errno || number < lowest || number > highest)
    throw ConfigError("--" + name + " " + value + ": must be a whole number from " + std::to_string(lowest) +
                      " to " + std::to_string(highest));
  return number;
}

/// Without what an option needs and excludes: the refusal says so.
class Formatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_name().empty() ? "" : " " + option->get_type_name();
  }
};

/// The page of a topic.
constexpr const char* every_topic = "all";

constexpr const char* help_with_topic = "--help=";

bool asks_for_help(const std::string& argument) { return argument == "--help" || argument == "-h"; }

}  // namespace

Options::Options(std::string program, const std::string& about)
    : program_(std::move(program)),
      app_(std::make_unique<CLI::App>(wrapped(about, name_columns + description_columns) + "\n", program_)) {
  app_->allow_extras();  // parse() refuses them with the nearest known name
  app_->formatter(std::make_shared<Formatter>());
  app_->get_formatter()->column_width(name_columns);
  app_->set_help_flag("-h,--help", "print this text");
}

Options::~Options() = default;
Options::Options(Options&&) noexcept = default;

Options& Options::positional(const std::string& name, const std::string& help, std::size_t least,
                             std::size_t most) {
  positional_name_ = name;
  least_ = least;
  most_ = most;
  first_positional_ = app_->add_option(name + (most > 1 ? "..." : ""), CLI::callback_t(any_value),
                                       wrapped(help, description_columns));
  first_positional_->required(least > 0);
  return *this;
}

Options& Options::option(const std::string& name, const std::string& value, const std::string& help) {
  last_ = app_->add_option("--" + name, CLI::callback_t(any_value), wrapped(help, description_columns));
  last_->type_name(value)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->group(heading_);
  return *this;
}

Options& Options::flag(const std::string& name, const std::string& help) {
  const std::string description = wrapped(help, description_columns);
  last_ = app_->add_flag("--" + name, description)->disable_flag_override();
  last_->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->group(heading_);
  return *this;
}

Options& Options::required() {
  last_->required();
  return *this;
}

Options& Options::needs(const std::string& other) {
  last_->needs(app_->get_option("--" + other));
  return *this;
}

Options& Options::excludes(const std::string& other) {
  last_->excludes(app_->get_option("--" + other));
  return *this;
}

Options& Options::section(const std::string& heading) {
  heading_ = heading;
  return *this;
}

Options& Options::topic(const std::string& name, const std::string& heading) {
  topics_.push_back({name, heading});
  return section(heading);
}

Options& Options::essential() {
  essential_.push_back(last_);
  return *this;
}

Options& Options::footer(const std::string& text) {
  app_->footer(text);
  return *this;
}

void Options::parse(int argc, const char* const* argv) {
  for (int n = 1; n < argc; ++n) {  // CLI11 would take the next argument as its value
    const std::string argument = argv[n];
    if (argument.rfind("--", 0) == 0 && argument.find('=') + 1 == argument.size())
      throw ConfigError(argument + ": needs a value that is not empty");
  }
  try {
    app_->parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    help_ = true;
    read_topic(argc, argv);
    return;
  } catch (const CLI::ArgumentMismatch& e) {
    throw ConfigError(mismatch_text(e));
  } catch (const CLI::ParseError& e) {
    positional_left();  // a misspelt option is why another one is missing
    refuse_empty_values();
    throw ConfigError(std::string(e.what()) + " (--help shows the usage)");
  }
  if (first_positional_) positional_ = first_positional_->results();
  for (const std::string& argument : positional_left()) positional_.push_back(argument);
  if (positional_.size() > most_)
    throw ConfigError("'" + positional_[most_] + "': unexpected argument (--help shows the usage)");
  if (positional_.size() < least_)
    throw ConfigError(positional_name_ + ": " + std::to_string(least_) + " of them are required, " +
                      std::to_string(positional_.size()) + " given (--help shows the usage)");
  refuse_empty_values();
}

std::vector<std::string> Options::positional_left() const {
  std::vector<std::string> positional;
  bool options_ended = false;
  for (const std::string& argument : app_->remaining()) {
    if (argument == "--") {
      options_ended = true;
    } else if (options_ended || argument.rfind('-', 0) != 0) {
      positional.push_back(argument);
    } else {
      std::string all;
      for (const CLI::Option* option : static_cast<const CLI::App&>(*app_).get_options())
        if (option->nonpositional())
          for (const std::string& name : option->get_lnames()) all += (all.empty() ? "--" : ", --") + name;
      throw ConfigError(argument + ": unknown option (--help lists them)" +
                        did_you_mean(argument.substr(0, argument.find('=')), all));
    }
  }
  return positional;
}

void Options::refuse_empty_values() const {
  for (const CLI::Option* option : static_cast<const CLI::App&>(*app_).get_options())
    for (const std::string& value : option->results())
      if (value.empty()) throw ConfigError(option->get_name() + " '': needs a value that is not empty");
}

void Options::read_topic(int argc, const char* const* argv) {
  if (topics_.empty()) return;
  for (int n = 1; n < argc; ++n) {
    const std::string argument = argv[n];
    if (argument.rfind(help_with_topic, 0) == 0)
      shown_topic_ = argument.substr(std::string(help_with_topic).size());
    else if (asks_for_help(argument) && n + 1 < argc && argv[n + 1][0] != '-')
      shown_topic_ = argv[n + 1];
  }
  std::string names;
  for (const Topic& topic : topics_) names += topic.name + ", ";
  names += every_topic;
  const auto is_shown = [&](const Topic& topic) { return topic.name == shown_topic_; };
  if (!shown_topic_.empty() && shown_topic_ != every_topic &&
      std::none_of(topics_.begin(), topics_.end(), is_shown))
    throw ConfigError("--help " + shown_topic_ + ": there is no such topic, only " + names +
                      did_you_mean(shown_topic_, names));
}

std::string Options::usage() const {
  if (topics_.empty() || shown_topic_ == every_topic) return app_->help();
  Formatter format;
  format.column_width(name_columns);
  const CLI::App& app = *app_;
  if (!shown_topic_.empty()) {
    const auto topic =
        std::find_if(topics_.begin(), topics_.end(), [&](const Topic& t) { return t.name == shown_topic_; });
    return format.make_usage(&app, program_) +
           format.make_group(topic->heading, false, app.get_options([&](const CLI::Option* option) {
             return option->nonpositional() && option->get_group() == topic->heading;
           }));
  }
  std::vector<const CLI::Option*> shown{app.get_help_ptr()};
  shown.insert(shown.end(), essential_.begin(), essential_.end());
  std::ostringstream topics;
  for (const Topic& topic : topics_)
    CLI::detail::format_help(topics, "--help " + topic.name, topic.heading, name_columns);
  CLI::detail::format_help(topics, std::string("--help ") + every_topic, "All options", name_columns);
  return format.make_description(&app) + format.make_usage(&app, program_) + format.make_positionals(&app) +
         format.make_group("Options", false, shown) + "\nAll options, by topic:\n" + topics.str() + '\n' +
         format.make_footer(&app);
}

CLI::Option* Options::declared(const std::string& name) const {
  return app_->get_option_no_throw("--" + name);
}

bool Options::has(const std::string& name) const {
  const CLI::Option* const option = declared(name);
  return option && option->count() > 0;
}

std::string Options::text(const std::string& name, const std::string& default_value) const {
  const CLI::Option* const option = declared(name);
  return option && option->count() > 0 ? option->results().back() : default_value;
}

std::vector<std::string> Options::values(const std::string& name) const {
  const CLI::Option* const option = declared(name);
  return option ? option->results() : std::vector<std::string>();
}

long long Options::number(const std::string& name, long long default_value, long long lowest,
                          long long highest) const {
  return has(name) ? whole_number(name, text(name, ""), lowest, highest) : default_value;
}

std::vector<int> Options::numbers(const std::string& name, const std::vector<int>& default_values, int lowest,
                                  int highest) const {
  if (!has(name)) return default_values;
  std::vector<int> all;
  for (const std::string& value : values(name))
    all.push_back(static_cast<int>(whole_number(name, value, lowest, highest)));
  return all;
}

double Options::real(const std::string& name, double default_value, double lowest, double highest) const {
  if (!has(name)) return default_value;
  const std::string value = text(name, "");
  std::istringstream in(value);
  in.imbue(std::locale::classic());
  double number = 0;
  std::string more;
  if (!(in >> number) || (in >> more) || !(number >= lowest && number <= highest))
    throw ConfigError("--" + name + " " + value + ": must be a number from " + number_text(lowest) + " to " +
                      number_text(highest));
  return number;
}

}  // namespace desert_sim
