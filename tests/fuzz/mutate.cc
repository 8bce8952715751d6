#include <algorithm>
#include <array>
#include <random>

#include "tests/fuzz/target.h"

namespace twinbench::fuzz {
namespace {

constexpr std::size_t kLongest = 1 << 20, kLongestPiece = 256;
constexpr std::array<std::string_view, 30> kStumbles = {
    "0", "-1", "1e308", "-1e308", "1e-320", "nan", "inf", "2147483648", "-9223372036854775808", "99999999999999999999",
    "\n", "\r\n", ";", ",", ":", "\"", "'", "[", "]", "{", "}", "=", "#", "?", "*", " ", "\t", "\"\"\"", "\xff\xfe", "[["};

/// Choices of one input.
class Dice {
 public:
  explicit Dice(std::uint64_t number) : random_(number * 0x9e3779b97f4a7c15u + 1) {}
  /// Below n, which is above 0. The standard's own distributions differ from library to library.
  std::size_t Below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  std::size_t PieceOf(std::size_t size) { return 1 + Below(std::min(size, kLongestPiece)); }

 private:
  std::mt19937_64 random_;
};

void ChangeByte(std::string& text, Dice& dice) {
  if (text.empty()) return;
  text[dice.Below(text.size())] = static_cast<char>(dice.Below(256));
}

void FlipBit(std::string& text, Dice& dice) {
  if (text.empty()) return;
  char& byte = text[dice.Below(text.size())];
  byte = static_cast<char>(byte ^ (1 << dice.Below(8)));
}

void LeaveOut(std::string& text, Dice& dice) {
  if (text.empty()) return;
  const std::size_t at = dice.Below(text.size());
  text.erase(at, dice.PieceOf(text.size() - at));
}

void Insert(std::string& text, std::string_view piece, Dice& dice) {
  text.insert(dice.Below(text.size() + 1), piece);
}

/// A piece of `from`, which is not the text itself.
void Graft(std::string& text, const std::string& from, Dice& dice) {
  if (from.empty()) return;
  const std::size_t at = dice.Below(from.size());
  Insert(text, std::string_view(from).substr(at, dice.PieceOf(from.size() - at)), dice);
}

/// Digits somewhere become another number.
void ChangeNumber(std::string& text, Dice& dice) {
  if (text.empty()) return;
  constexpr std::string_view kDigits = "0123456789";
  const auto begin = text.find_first_of(kDigits, dice.Below(text.size()));
  if (begin == text.npos) return;
  const auto end = std::min(text.find_first_not_of(kDigits, begin), text.size());
  text.replace(begin, end - begin, kStumbles[dice.Below(10)]);
}

void Change(std::string& text, const std::vector<std::string>& seeds, Dice& dice) {
  switch (dice.Below(8)) {
    case 0:
      return ChangeByte(text, dice);
    case 1:
      return FlipBit(text, dice);
    case 2:
      return LeaveOut(text, dice);
    case 3:
      return Graft(text, std::string(text), dice);
    case 4:
      return Graft(text, seeds[dice.Below(seeds.size())], dice);
    case 5:
      return ChangeNumber(text, dice);
    case 6:
      return text.resize(dice.Below(text.size() + 1));
    default:
      return Insert(text, kStumbles[dice.Below(kStumbles.size())], dice);
  }
}

}  // namespace

std::string Mutated(const std::vector<std::string>& seeds, std::uint64_t number) {
  Dice dice(number);
  std::string text = seeds[dice.Below(seeds.size())].substr(0, kLongest);
  for (std::size_t changes = 1 + dice.Below(8); changes > 0; --changes) Change(text, seeds, dice);
  return text;
}

}  // namespace twinbench::fuzz
