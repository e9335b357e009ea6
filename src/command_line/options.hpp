#pragma once
/// The command line of a program: declared once, from which CLI11 reads the arguments and --help is made.

#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace desert_sim {

class Options {
 public:
  /// `about`: what the program does. Each program has the flag --help (-h), and one whose options are in
  /// topics has `--help TOPIC` and `--help all`, too.
  Options(std::string program, const std::string& about);
  ~Options();
  Options(Options&&) noexcept;

  /// Declares the arguments without a name, of which there must be `least` to `most`.
  Options& positional(const std::string& name, const std::string& help, std::size_t least = 1,
                      std::size_t most = 1);
  /// Declares `--name VALUE`. It may be repeated: of a list all values count, else the last one.
  Options& option(const std::string& name, const std::string& value, const std::string& help);
  /// Declares `--name`, which takes no value.
  Options& flag(const std::string& name, const std::string& help);
  /// The command line is refused without the option that was declared last.
  Options& required();
  /// The option that was declared last is refused without, or beside, another one declared before.
  Options& needs(const std::string& other);
  Options& excludes(const std::string& other);
  /// The heading over the options that are declared next.
  Options& section(const std::string& heading);
  /// Begins a topic, a word: a section with this heading that --help names only, and `--help name` shows.
  Options& topic(const std::string& name, const std::string& heading);
  /// The option that was declared last is in --help although it is in a topic.
  Options& essential();
  /// What --help says at its end.
  Options& footer(const std::string& text);

  /// Throws ConfigError that names the argument: an unknown option (with the nearest known one), too many or
  /// too few positional arguments, values that are missing or empty, what needs or excludes another option;
  /// beside --help, only an unknown topic.
  void parse(int argc, const char* const* argv);
  /// --help was given.
  bool help() const { return help_; }
  /// The text of --help, or of the topic that was given with it.
  std::string usage() const;

  const std::string& program() const { return program_; }
  const std::vector<std::string>& positional() const { return positional_; }
  bool has(const std::string& name) const;
  /// The last value of an option, or `default_value` if it was not given.
  std::string text(const std::string& name, const std::string& default_value) const;
  /// All values of an option in order.
  std::vector<std::string> values(const std::string& name) const;
  /// The last value as an integer in [lowest, highest], or `default_value` if the option was not given.
  /// Throws ConfigError.
  long long number(const std::string& name, long long default_value, long long lowest,
                   long long highest) const;
  /// All values likewise.
  std::vector<int> numbers(const std::string& name, const std::vector<int>& default_values, int lowest,
                           int highest) const;
  /// The last value likewise as a number.
  double real(const std::string& name, double default_value, double lowest, double highest) const;

 private:
  CLI::Option* declared(const std::string& name) const;
  /// Of what CLI11 did not take: throws ConfigError for an unknown option, returns the rest.
  std::vector<std::string> positional_left() const;
  void refuse_empty_values() const;
  /// Of the word after --help, if the options are in topics: throws ConfigError for an unknown one.
  void read_topic(int argc, const char* const* argv);

  struct Topic {
    std::string name, heading;
  };
  std::string program_, heading_ = "Options";
  std::vector<Topic> topics_;
  std::vector<const CLI::Option*> essential_;
  std::string shown_topic_;  // that --help asks for; empty: the essential options
  std::unique_ptr<CLI::App> app_;
  CLI::Option *last_ = nullptr, *first_positional_ = nullptr;
  std::string positional_name_;
  std::size_t least_ = 0, most_ = 0;
  std::vector<std::string> positional_;
  bool help_ = false;
};

}  // namespace desert_sim
