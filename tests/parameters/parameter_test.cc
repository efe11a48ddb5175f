#include "parameters/parameter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "parameters/input_error.h"

namespace rcme {
namespace {

enum class Color { kRed, kGreen };

struct Options {
  double real = 0.25, open = 1.0, automatic = std::numeric_limits<double>::quiet_NaN();
  int integer = 7;
  std::string text = "some words";
  Color color = Color::kGreen;
};

std::vector<Parameter> Parameters(Options& o) {
  return {Parameter::Real("real", &o.real, {0.0, 1.0}, "px", "a bounded number"),
          Parameter::Real("open", &o.open, {}, "", "any number"),
          Parameter::RealOrWord("automatic", &o.automatic, {-2.0, 2.0}, "auto", "nats", "a number or auto"),
          Parameter::Integer("integer", &o.integer, {1, 1e6}, "a count"),
          Parameter::Choice<Color>("color", &o.color, {{"red", Color::kRed}, {"green", Color::kGreen}}, ""),
          Parameter::Text("text", &o.text, "a path", "any words")};
}

// The message of the InputError that `text` provokes; empty if it is accepted.
std::string Refusal(Options& options, const std::string& key, const std::string& text) {
  const std::vector<Parameter> parameters = Parameters(options);
  try {
    FindParameter(parameters, key).SetFromText(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Parameter, RealIsSetAndKeepsItsBounds) {
  Options o;
  EXPECT_EQ(Refusal(o, "real", "0.125"), "");
  EXPECT_EQ(o.real, 0.125);
  EXPECT_EQ(Refusal(o, "real", "1"), "") << "the bound itself is allowed";
  EXPECT_EQ(Refusal(o, "real", "0"), "");
  EXPECT_EQ(Refusal(o, "real", "2.5e-1"), "");
  EXPECT_EQ(o.real, 0.25);
}

TEST(Parameter, WrongTextIsRefusedAndLeavesTheFieldAlone) {
  for (const std::string text : {"-0.001", "1.001", "nan", "NaN", "-nan", "inf", "-inf", "infinity", "1e999",
                                 "", " ", "0.5 ", " 0.5", "0.5px", "0,5", "half", "--1", "0x1"}) {
    Options o;
    EXPECT_NE(Refusal(o, "real", text), "") << "'" << text << "'";
    EXPECT_EQ(o.real, 0.25) << "'" << text << "'";
  }
  for (const std::string text : {"nan", "inf", "-inf", "1e999", "", "x"}) {
    Options o;
    EXPECT_NE(Refusal(o, "open", text), "") << "'" << text << "'";
    EXPECT_EQ(o.open, 1.0);
  }
  for (const std::string text :
       {"0", "1000001", "1.5", "1e3", "99999999999999999999", "4294967297", "nan", "", "seven", "7 "}) {
    Options o;
    EXPECT_NE(Refusal(o, "integer", text), "") << "'" << text << "'";
    EXPECT_EQ(o.integer, 7);
  }
  for (const std::string text : {"blue", "Red", "", "red ", "0"}) {
    Options o;
    EXPECT_NE(Refusal(o, "color", text), "") << "'" << text << "'";
    EXPECT_EQ(o.color, Color::kGreen);
  }
}

TEST(Parameter, IntegerBeyondIntIsRefusedEvenWithoutBounds) {
  int value = 3;
  const Parameter parameter = Parameter::Integer("n", &value, {}, "");
  EXPECT_THROW(parameter.SetFromText("2147483648"), InputError);
  EXPECT_THROW(parameter.SetFromText("-2147483649"), InputError);
  EXPECT_EQ(value, 3);
  parameter.SetFromText("-2147483648");
  EXPECT_EQ(value, std::numeric_limits<int>::min());
}

TEST(Parameter, WordIsStoredAsNanAndBack) {
  Options o;
  EXPECT_EQ(Refusal(o, "automatic", "-1.5"), "");
  EXPECT_EQ(o.automatic, -1.5);
  EXPECT_EQ(Refusal(o, "automatic", "auto"), "");
  EXPECT_TRUE(std::isnan(o.automatic));
  EXPECT_EQ(Parameters(o)[2].Value(), "auto");
  EXPECT_NE(Refusal(o, "automatic", "nan"), "") << "NaN is written by its word";
  EXPECT_NE(Refusal(o, "automatic", "Auto"), "");
  EXPECT_NE(Refusal(o, "automatic", "2.1"), "");
}

TEST(Parameter, TextIsTakenAsItIsUnlessEmpty) {
  Options o;
  EXPECT_EQ(Refusal(o, "text", " a path with spaces/nan "), "");
  EXPECT_EQ(o.text, " a path with spaces/nan ");
  EXPECT_EQ(Refusal(o, "text", ""), "text: '' is not allowed; give a path");
  EXPECT_EQ(o.text, " a path with spaces/nan ");
}

TEST(Parameter, ChoiceIsSetByItsWord) {
  Options o;
  EXPECT_EQ(Refusal(o, "color", "red"), "");
  EXPECT_EQ(o.color, Color::kRed);
}

TEST(Parameter, MessageNamesKeyValueAndWhatIsAllowed) {
  Options o;
  EXPECT_EQ(Refusal(o, "real", "1.5"), "real: '1.5' is not allowed; give a number in [0, 1]");
  EXPECT_EQ(Refusal(o, "open", "x"), "open: 'x' is not allowed; give a number");
  EXPECT_EQ(Refusal(o, "automatic", "x"), "automatic: 'x' is not allowed; give a number in [-2, 2] or auto");
  EXPECT_EQ(Refusal(o, "integer", "x"), "integer: 'x' is not allowed; give a whole number in [1, 1000000]");
  EXPECT_EQ(Refusal(o, "color", "blue"), "color: 'blue' is not allowed; give one of: red, green");
}

TEST(Parameter, OneSidedRangesAreSpelledOut) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double value = 0.0;
  EXPECT_EQ(Parameter::Real("x", &value, {0.5, kInfinity}, "", "").allowed(), "a number >= 0.5");
  EXPECT_EQ(Parameter::Real("x", &value, {-kInfinity, 0.5}, "", "").allowed(), "a number <= 0.5");
}

TEST(Parameter, ValueRoundTripChangesNothing) {
  for (const double value : {0.1, 1.0 / 3.0, 1e-9, 5e-324, 0.0, 1.0, 0.30000000000000004}) {
    Options o;
    o.real = o.open = o.automatic = value;
    for (const Parameter& parameter : Parameters(o)) parameter.SetFromText(parameter.Value());
    EXPECT_EQ(o.real, value);
    EXPECT_EQ(o.open, value);
    EXPECT_EQ(o.automatic, value);
    EXPECT_EQ(o.integer, 7);
    EXPECT_EQ(o.color, Color::kGreen);
    EXPECT_EQ(o.text, "some words");
  }
  Options huge;
  huge.open = -std::numeric_limits<double>::max();
  Parameters(huge)[1].SetFromText(Parameters(huge)[1].Value());
  EXPECT_EQ(huge.open, -std::numeric_limits<double>::max());
}

TEST(Parameter, CarriesItsDescription) {
  Options o;
  const Parameter parameter = Parameters(o)[0];
  EXPECT_EQ(parameter.name(), "real");
  EXPECT_EQ(parameter.unit(), "px");
  EXPECT_EQ(parameter.doc(), "a bounded number");
}

TEST(Parameter, TogetherSetsAllOrNone) {
  double first = 1.0, second = 2.0;
  const Parameter both =
      Parameter::Together({Parameter::Real("shift", &first, {0.0, 9.0}, "px", "a shift"),
                           Parameter::Real("shift", &second, {0.0, 9.0}, "px", "a shift")});
  EXPECT_EQ(both.Value(), "1");
  both.SetFromText("5");
  EXPECT_EQ(first, 5.0);
  EXPECT_EQ(second, 5.0);
  EXPECT_THROW(both.SetFromText("10"), InputError);
  EXPECT_EQ(first, 5.0);
  EXPECT_EQ(second, 5.0);
}

TEST(FindParameter, UnknownKeyListsTheKnownOnes) {
  Options o;
  EXPECT_EQ(Refusal(o, "colour", "red"),
            "unknown key 'colour' (did you mean 'color'?); known keys: real, open, automatic, integer, "
            "color, text");
}

TEST(ParseNumber, TakesTheWholeTextOrNothing) {
  double real = -1.0;
  long long integer = -1;
  EXPECT_TRUE(ParseReal("1e3", &real));
  EXPECT_EQ(real, 1000.0);
  EXPECT_FALSE(ParseReal("1e3 ", &real));
  EXPECT_FALSE(ParseReal("nan", &real));
  EXPECT_EQ(real, 1000.0) << "untouched by a refusal";
  EXPECT_TRUE(ParseInteger("-42", &integer));
  EXPECT_EQ(integer, -42);
  EXPECT_FALSE(ParseInteger("4.2", &integer));
  EXPECT_FALSE(ParseInteger("1e3", &integer));
}

}  // namespace
}  // namespace rcme
