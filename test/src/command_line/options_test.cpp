// Command lines: what is read, what is refused, what --help says.

#include "src/command_line/options.hpp"

#include <gtest/gtest.h>

#include "src/core/error.hpp"

namespace desert_sim {
namespace {

using Words = std::vector<std::string>;

Options parse(const Words& arguments, std::size_t least = 0, std::size_t most = 2) {
  Options o("program", "Does something.");
  o.positional("FILE", "what is read", least, most)
      .option("steps", "N", "how many steps")
      .option("duration", "T", "in place of --steps")
      .excludes("steps")
      .section("Output")
      .option("set", "KEY=VALUE", "a setting; may be repeated")
      .option("out", "FOLDER", "where what is computed is written to, which is told here at some length")
      .option("every", "N", "how often")
      .needs("out")
      .flag("quiet", "say nothing")
      .footer("Exit status: 0.");
  std::vector<const char*> argv{"program"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  o.parse(static_cast<int>(argv.size()), argv.data());
  return o;
}

std::string refusal(const Words& arguments, std::size_t least = 0, std::size_t most = 2) {
  try {
    parse(arguments, least, most);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "nothing is refused";
}

TEST(Options, AreReadInAnyOrderWithSpaceOrEquals) {
  const Options o = parse({"--quiet", "a.yaml", "--set", "x=1", "--steps=12", "--set=y=2", "b.yaml"});
  EXPECT_EQ(o.positional(), (Words{"a.yaml", "b.yaml"}));
  EXPECT_TRUE(o.has("quiet"));
  EXPECT_EQ(o.number("steps", 0, 0, 100), 12);
  EXPECT_EQ(o.values("set"), (Words{"x=1", "y=2"}));
  EXPECT_FALSE(parse({}).has("steps"));
  EXPECT_EQ(parse({}).number("steps", 7, 0, 100), 7);
  EXPECT_EQ(parse({}).text("set", "none"), "none");
  EXPECT_EQ(parse({"--steps", "1", "--steps", "2"}).number("steps", 0, 0, 100), 2);
  EXPECT_FALSE(o.has("not_declared"));
}

/// An option takes the next argument whatever it looks like, and none of those after it.
TEST(Options, ValuesAndFilesMayLookLikeOptionsOrLists) {
  EXPECT_EQ(parse({"--set", "-5,3", "a"}).values("set"), Words{"-5,3"});
  EXPECT_EQ(parse({"--set", "--quiet"}).values("set"), Words{"--quiet"});
  EXPECT_FALSE(parse({"--set", "--quiet"}).has("quiet"));
  EXPECT_EQ(parse({"--set", "[a,b]", "[c,d]"}).values("set"), Words{"[a,b]"});
  EXPECT_EQ(parse({"[c,d]"}).positional(), Words{"[c,d]"});
  EXPECT_EQ(parse({"a", "--", "-b"}).positional(), (Words{"a", "-b"}));
}

TEST(Options, AreRefusedByName) {
  EXPECT_EQ(refusal({"--stpes", "3"}),
            "--stpes: unknown option (--help lists them); did you mean '--steps'?");
  EXPECT_EQ(refusal({"--stpes=3"}), "--stpes=3: unknown option (--help lists them); did you mean '--steps'?");
  EXPECT_EQ(refusal({"-x"}), "-x: unknown option (--help lists them)");
  EXPECT_EQ(refusal({"--steps"}), "--steps: needs a value");
  EXPECT_EQ(refusal({"--steps="}), "--steps=: needs a value that is not empty");
  EXPECT_EQ(refusal({"--steps", ""}), "--steps '': needs a value that is not empty");
  EXPECT_EQ(refusal({"--quiet=yes"}), "--quiet: takes no value");
  EXPECT_EQ(refusal({"--every", "3"}), "--every requires --out (--help shows the usage)");
  EXPECT_EQ(refusal({"--stpes", "3"}, 2), refusal({"--stpes", "3"})) << "not that a file is missing";
  EXPECT_EQ(refusal({"--duration=3", "--steps=1"}), "--steps excludes --duration (--help shows the usage)");
  EXPECT_NE(refusal({"--=3"}), "nothing is refused");
}

TEST(Options, PositionalArgumentsAreCounted) {
  EXPECT_EQ(refusal({"a", "b", "c"}), "'c': unexpected argument (--help shows the usage)");
  EXPECT_EQ(refusal({"a", "b"}, 1, 1), "'b': unexpected argument (--help shows the usage)");
  EXPECT_EQ(refusal({}, 1, 1), "FILE is required (--help shows the usage)");
  EXPECT_EQ(refusal({"a"}, 2, 2), "FILE: 2 of them are required, 1 given (--help shows the usage)");
  EXPECT_NE(refusal({""}, 1, 1), "nothing is refused");
}

TEST(Options, NumbersAreWholeAndInTheirRange) {
  for (const char* value : {"x", "1x", "1.5", "-1", "101", "99999999999999999999999", " "})
    EXPECT_THROW(parse({"--steps", value}).number("steps", 0, 0, 100), ConfigError) << "'" << value << "'";
  EXPECT_EQ(parse({"--steps", "100"}).number("steps", 0, 0, 100), 100);
  EXPECT_EQ(parse({"--set", "3", "--set", "5"}).numbers("set", {7}, 0, 9), (std::vector<int>{3, 5}));
  EXPECT_EQ(parse({}).numbers("set", {7}, 0, 9), std::vector<int>{7});
  EXPECT_THROW(parse({"--set", "3", "--set", "10"}).numbers("set", {7}, 0, 9), ConfigError);
}

TEST(Options, HelpIsMadeFromTheDeclarationsWhateverElseIsGiven) {
  for (const Words& arguments : {Words{"--help"}, Words{"-h", "--stpes"}, Words{"a", "b", "c", "--help"}}) {
    const Options o = parse(arguments, 1, 1);
    ASSERT_TRUE(o.help()) << arguments[0];
    const std::string text = o.usage();
    std::size_t at = 0;
    for (const char* part :
         {"Does something.", "program [OPTIONS] FILE", "FILE", "what is read", "--help", "--steps N",
          "how many steps", "Output:", "--set KEY=VALUE", "--quiet", "Exit status: 0."}) {
      const std::size_t found = text.find(part, at);
      ASSERT_NE(found, std::string::npos) << part << " after\n" << text.substr(0, at);
      at = found;
    }
    for (std::size_t begin = 0; begin < text.size(); begin = text.find('\n', begin) + 1)
      EXPECT_LE(text.find('\n', begin) - begin, 80U) << text.substr(begin, 100);
  }
  EXPECT_FALSE(parse({}).help());
}

Options parse_topics(const Words& arguments) {
  Options o("program", "Does something.");
  o.positional("FILE", "what is read", 0)
      .topic("run", "Length of a run")
      .option("steps", "N", "how many steps")
      .essential()
      .option("threads", "N", "how many threads")
      .topic("output", "What is written")
      .option("out", "FOLDER", "where to")
      .essential()
      .flag("quiet", "say nothing")
      .footer("Exit status: 0.");
  std::vector<const char*> argv{"program"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  o.parse(static_cast<int>(argv.size()), argv.data());
  return o;
}

TEST(Options, HelpOfTopicsShowsWhatIsEssentialAndEachTopic) {
  struct Page {
    Words arguments, shown, not_shown;
  };
  for (const Page& page :
       {Page{{"--help"},
             {"Does something.", "FILE", "--help", "--steps N", "--out FOLDER", "--help run",
              "Length of a run", "--help output", "--help all", "Exit status: 0."},
             {"--threads", "--quiet"}},
        Page{{"--help", "output"}, {"What is written:", "--out FOLDER", "--quiet"}, {"--steps", "--threads"}},
        Page{{"a", "--quiet", "-h", "run", "--stpes"},
             {"Length of a run:", "--steps N", "--threads N"},
             {"--out", "--quiet"}},
        Page{{"--help=output"}, {"What is written:", "--quiet"}, {"--steps"}},
        Page{{"--help", "all"},
             {"Does something.", "FILE", "Length of a run:", "--threads", "What is written:", "--quiet"},
             {"--help run"}},
        Page{{"run", "--help", "--quiet"}, {"--help run"}, {"--threads"}}}) {
    const Options o = parse_topics(page.arguments);
    ASSERT_TRUE(o.help());
    std::size_t at = 0;
    for (const std::string& part : page.shown) {
      const std::size_t found = o.usage().find(part, at);
      ASSERT_NE(found, std::string::npos) << part << " in\n" << o.usage();
      at = found;
    }
    for (const std::string& part : page.not_shown)
      EXPECT_EQ(o.usage().find(part), std::string::npos) << part << " in\n" << o.usage();
  }
  EXPECT_FALSE(parse_topics({"--quiet"}).help());
}

TEST(Options, AnUnknownTopicIsRefusedWithTheList) {
  try {
    parse_topics({"--help", "ouptut"});
    ADD_FAILURE() << "nothing is refused";
  } catch (const ConfigError& e) {
    EXPECT_STREQ(e.what(),
                 "--help ouptut: there is no such topic, only run, output, all; did you mean 'output'?");
  }
}

}  // namespace
}  // namespace desert_sim
