#include "stats/exact_moments.h"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "stats/constants.h"

namespace rcme {
namespace {

using boost::multiprecision::cpp_int;

constexpr int kUnit = -1074;       // exponent of the smallest double
constexpr size_t kNumDigits = 68;  // 2^1024 * 2^1074, with room for 2^64 numbers
constexpr int kAddsToCarry = 1 << 30;
constexpr double kMaxSquared = 1e150;

cpp_int WholeNumber(const ExactSum& sum) {
  cpp_int number = 0;
  const std::vector<std::int64_t>& digits = sum.digits();
  for (size_t i = digits.size(); i-- > 0;) number = (number << 32) + digits[i];
  return number;
}

// numerator / denominator * 2^exponent, to 64 bits; the denominator is positive.
double Ratio(const cpp_int& numerator, const cpp_int& denominator, int exponent) {
  if (numerator == 0) return 0.0;
  const cpp_int magnitude = abs(numerator);
  const int shift = 66 - static_cast<int>(msb(magnitude)) + static_cast<int>(msb(denominator));
  const cpp_int quotient =
      shift >= 0 ? cpp_int((magnitude << shift) / denominator) : cpp_int(magnitude / (denominator << -shift));
  const double value = static_cast<double>(std::ldexp(quotient.convert_to<long double>(), exponent - shift));
  return numerator < 0 ? -value : value;
}

// Digits of a whole number that is not negative.
std::vector<std::int64_t> ListDigits(cpp_int number) {
  std::vector<std::int64_t> digits(kNumDigits, 0);
  for (size_t i = 0; i < kNumDigits && number != 0; ++i, number >>= 32)
    digits[i] = static_cast<std::int64_t>(cpp_int(number & 0xffffffffu));
  if (number != 0) throw std::invalid_argument("exact sum: too great");
  return digits;
}

template <typename Integer>
Integer ParsedInteger(const std::string& text) {
  Integer value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty())
    throw std::invalid_argument("not a whole number: " + text);
  return value;
}

}  // namespace

void ExactSum::Add(double x) {
  if (!std::isfinite(x)) throw std::invalid_argument("exact sum: a number is not finite");
  if (x == 0.0) return;
  if (digits_.empty()) digits_.assign(kNumDigits, 0);
  if (++num_added_ >= kAddsToCarry) Carry();
  int exponent = 0;
  // x = mantissa * 2^exponent, with at most 53 bits; of the smallest numbers fewer.
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
  exponent -= 53;
  if (exponent < kUnit) {
    mantissa /= std::int64_t{1} << (kUnit - exponent);  // exact: the dropped bits are zero
    exponent = kUnit;
  }
  const auto at = static_cast<size_t>(exponent - kUnit);
  const std::uint64_t magnitude = static_cast<std::uint64_t>(std::abs(mantissa));
  const std::int64_t sign = x < 0.0 ? -1 : 1;
  // The mantissa at bit `at`: 53 bits moved by up to 31 reach into three digits.
  const size_t digit = at / 32, shift = at % 32;
  const std::uint64_t low = (magnitude << shift) & 0xffffffffu;
  const std::uint64_t middle = (magnitude >> (32 - shift)) & 0xffffffffu;
  const std::uint64_t high = shift == 0 ? 0 : magnitude >> (64 - shift);
  digits_[digit] += sign * static_cast<std::int64_t>(low);
  digits_[digit + 1] += sign * static_cast<std::int64_t>(middle);
  digits_[digit + 2] += sign * static_cast<std::int64_t>(high);
}

void ExactSum::Carry() const {
  std::int64_t carry = 0;
  for (size_t i = 0; i + 1 < digits_.size(); ++i) {
    const std::int64_t sum = digits_[i] + carry;
    carry = sum >> 32;  // towards minus infinity
    digits_[i] = sum & 0xffffffff;
  }
  if (!digits_.empty()) digits_.back() += carry;
  num_added_ = 0;
}

const std::vector<std::int64_t>& ExactSum::digits() const {
  Carry();
  return digits_;
}

void ExactSum::Merge(const ExactSum& other) {
  const std::vector<std::int64_t>& others = other.digits();
  if (others.empty()) return;
  if (digits_.empty()) digits_.assign(kNumDigits, 0);
  Carry();
  for (size_t i = 0; i < kNumDigits; ++i) digits_[i] += others[i];
  Carry();
}

std::string ExactSum::Text() const {
  cpp_int number = WholeNumber(*this);
  if (number == 0) return "0";
  const std::string sign = number < 0 ? "-" : "";
  number = abs(number);
  const auto num_zeros = static_cast<int>(lsb(number));
  number >>= num_zeros;
  return sign + number.str(0, std::ios_base::hex) + 'p' + std::to_string(num_zeros + kUnit);
}

ExactSum ExactSum::FromText(const std::string& text) {
  ExactSum sum;
  if (text == "0") return sum;
  const bool is_negative = text.starts_with('-');
  const size_t begin = is_negative ? 1 : 0, end = text.find('p');
  const std::string hex = text.substr(begin, end == std::string::npos ? 0 : end - begin);
  if (hex.empty() || hex.size() > 600 || hex.find_first_not_of("0123456789abcdef") != std::string::npos)
    throw std::invalid_argument("not an exact sum: " + text);
  const int exponent = ParsedInteger<int>(text.substr(end + 1));
  if (exponent < kUnit || exponent > kUnit + 32 * static_cast<int>(kNumDigits))
    throw std::invalid_argument("not an exact sum: " + text);
  sum.digits_ = ListDigits(cpp_int("0x" + hex) << (exponent - kUnit));
  for (std::int64_t& digit : sum.digits_) digit *= is_negative ? -1 : 1;
  sum.Carry();
  return sum;
}

void ExactMoments::Add(double x) {
  if (std::isnan(x)) throw std::invalid_argument("exact moments: a number is NaN");
  ++n_;
  if (std::abs(x) > kMaxSquared) {
    (x > 0.0 ? has_plus_infinity_ : has_minus_infinity_) = true;
    return;
  }
  sum_.Add(x);
  const double square = x * x;
  sum_squares_.Add(square);
  sum_squares_.Add(std::fma(x, x, -square));  // the rounding error of the square
}

void ExactMoments::Merge(const ExactMoments& other) {
  n_ += other.n_;
  sum_.Merge(other.sum_);
  sum_squares_.Merge(other.sum_squares_);
  has_plus_infinity_ = has_plus_infinity_ || other.has_plus_infinity_;
  has_minus_infinity_ = has_minus_infinity_ || other.has_minus_infinity_;
}

double ExactMoments::mean() const {
  if (n_ == 0 || (has_plus_infinity_ && has_minus_infinity_)) return kNaN;
  if (has_plus_infinity_ || has_minus_infinity_) return has_plus_infinity_ ? kInfinity : -kInfinity;
  return Ratio(WholeNumber(sum_), n_, kUnit);
}

// (n sum x^2 - (sum x)^2) / (n (n - 1)): the difference, which cancels in floating point, is exact here.
double ExactMoments::variance() const {
  if (n_ < 2 || has_plus_infinity_ || has_minus_infinity_) return kNaN;
  const cpp_int sum = WholeNumber(sum_);
  const cpp_int difference = ((n_ * WholeNumber(sum_squares_)) << -kUnit) - sum * sum;
  return std::max(0.0, Ratio(difference, cpp_int(n_) * (n_ - 1), 2 * kUnit));
}

double ExactMoments::standard_error() const { return std::sqrt(variance() / static_cast<double>(n_)); }

std::vector<std::string> ExactMoments::Texts() const {
  const std::string sum = has_plus_infinity_ && has_minus_infinity_ ? "nan"
                          : has_plus_infinity_                      ? "inf"
                          : has_minus_infinity_                     ? "-inf"
                                                                    : sum_.Text();
  return {std::to_string(n_), sum, sum_squares_.Text()};
}

ExactMoments ExactMoments::FromTexts(const std::vector<std::string>& texts) {
  if (texts.size() != 3) throw std::invalid_argument("exact moments: not three texts");
  ExactMoments moments;
  moments.n_ = ParsedInteger<std::int64_t>(texts[0]);
  if (moments.n_ < 0) throw std::invalid_argument("exact moments: a negative number of numbers");
  moments.has_plus_infinity_ = texts[1] == "inf" || texts[1] == "nan";
  moments.has_minus_infinity_ = texts[1] == "-inf" || texts[1] == "nan";
  const bool is_finite = !moments.has_plus_infinity_ && !moments.has_minus_infinity_;
  if (is_finite) moments.sum_ = ExactSum::FromText(texts[1]);
  moments.sum_squares_ = ExactSum::FromText(texts[2]);
  return moments;
}

}  // namespace rcme
