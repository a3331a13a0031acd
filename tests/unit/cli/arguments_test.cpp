// SPDX-License-Identifier: MIT
#include "cli/arguments.h"

#include <gtest/gtest.h>

#include "text/numbers.h"
#include "words_of.h"

namespace ziggurat::cli {
namespace {

namespace po = boost::program_options;

po::options_description known() {
  po::options_description options;
  options.add_options()("ticks", po::value<std::string>())("quiet", "")(
      "real-time", po::value<std::string>()->implicit_value("1"));
  return options;
}

std::string complaint(const Arguments& arguments) {
  return words_of<text::UsageError>([&] { parse(arguments, known()); });
}

TEST(Arguments, OptionsMayStandAnywhere) {
  const auto parsed = parse({"a", "--ticks", "3", "b", "--quiet"}, known());
  EXPECT_EQ(parsed.positional, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(parsed.values["ticks"].as<std::string>(), "3");
  EXPECT_EQ(parsed.values.count("quiet"), 1u);
}

TEST(Arguments, TwoDashesEndTheOptions) {
  const auto parsed = parse({"--", "--ticks", "--real-time", "2"}, known());
  EXPECT_EQ(parsed.positional, (std::vector<std::string>{"--ticks", "--real-time", "2"}));
}

TEST(Arguments, NegativeNumbersAreValues) {
  const auto parsed =
      parse({"move", "b", "-0.3,0.2,0", "--quiet", "-.5,0,0", "--ticks", "-5", "-90"}, known());
  EXPECT_EQ(parsed.positional,
            (std::vector<std::string>{"move", "b", "-0.3,0.2,0", "-.5,0,0", "-90"}));
  EXPECT_EQ(parsed.values["ticks"].as<std::string>(), "-5");
  EXPECT_EQ(complaint({"-x"}), "unknown option '-x'; --help lists the options");
}

TEST(Arguments, OptionalValueIsTheNextWordOnlyIfThatIsANumber) {
  const auto real_time = [](const Arguments& arguments) {
    return parse(arguments, known()).values["real-time"].as<std::string>();
  };
  EXPECT_EQ(real_time({"--real-time"}), "1");
  EXPECT_EQ(real_time({"--real-time", "scene.argos"}), "1");
  EXPECT_EQ(real_time({"--real-time", "2.5", "scene.argos"}), "2.5");
  EXPECT_EQ(real_time({"--real-time=4"}), "4");
}

TEST(Arguments, AWordThatIsNeitherANumberNorAFileIsNoValue) {
  EXPECT_EQ(complaint({"--real-time", "fast", "scene.argos"}),
            "--real-time takes a number, the factor of real time (1 if it is left out); 'fast' is "
            "none, and no file has that name; write --real-time 2, for example, or --real-time=1 "
            "SCENE");
  EXPECT_EQ(complaint({"--real-time", "--quiet"}), "");
  EXPECT_EQ(complaint({"--real-time", "no/such/scene"}), "") << "told when it is opened";
}

TEST(Arguments, UnknownOptionsGetASuggestionIfOneIsNear) {
  EXPECT_EQ(complaint({"--tikcs", "3"}), "unknown option '--tikcs'; did you mean '--ticks'?");
  EXPECT_EQ(complaint({"--xyzzy"}), "unknown option '--xyzzy'; --help lists the options");
  EXPECT_NE(complaint({"--tick", "3"}), "") << "abbreviations are not guessed";
}

TEST(Arguments, ADashOfAWordProcessorIsTold) {
  EXPECT_EQ(complaint({"scene.argos", "–ticks", "3"}),
            "'–ticks' begins with a dash that is no hyphen; write --ticks");
  EXPECT_EQ(complaint({"——ticks=3"}),
            "'——ticks=3' begins with a dash that is no hyphen; write --ticks=3");
  EXPECT_EQ(complaint({"–", "–file.argos", "− 3", "--", "–ticks"}), "")
      << "files and values may begin so";
}

TEST(Arguments, AnEmptyValueIsAFault) {
  EXPECT_EQ(complaint({"--ticks", "", "a"}),
            "the value of --ticks is empty; write --ticks VALUE, or leave it out");
  po::options_description several;
  several.add_options()("endpoint", po::value<std::vector<std::string>>());
  EXPECT_THROW(parse({"--endpoint", "a", "--endpoint", ""}, several), text::UsageError);
  EXPECT_EQ(complaint({"--ticks", "1", "--quiet", "--real-time", "a.b", "--", ""}), "");
}

TEST(Arguments, MissingValuesAndRepetitionsAreFaults) {
  EXPECT_NE(complaint({"--ticks"}), "");
  EXPECT_NE(complaint({"--ticks", "1", "--ticks", "2"}).find("more than once"), std::string::npos);
}

}  // namespace
}  // namespace ziggurat::cli
