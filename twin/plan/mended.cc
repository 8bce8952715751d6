#include "twin/plan/mended.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace twinbench::plan {
namespace {

bool IsOfAWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0;
}

std::vector<std::string> Without(const std::vector<std::string>& all, const std::vector<std::string>& others) {
  std::vector<std::string> left;
  for (const std::string& one : all) {
    if (std::ranges::count(others, one) == 0) left.push_back(one);
  }
  return left;
}

/// "reference dx,dy orders +2, -4" is a part of "reference dy": the same words, components separated by commas.
bool IsPartOf(const std::string& part, const std::string& what) {
  if (part.starts_with(what) && (part.size() == what.size() || !IsOfAWord(part[what.size()]))) return true;
  const std::size_t space = what.find(' ');
  if (space == std::string::npos || !part.starts_with(what.substr(0, space + 1))) return false;
  const std::string component = what.substr(space + 1);
  const std::string components = "," + part.substr(space + 1, part.find(' ', space + 1) - space - 1) + ",";
  return components.find("," + component + ",") != std::string::npos;
}

/// Whether what stays lost is a part of that: by its words, or as it is by its words a part of nothing that the own run loses ("order 2" of
/// "both tables").
bool StaysOf(const Outlook& own, const std::string& stays, const std::string& what) {
  return IsPartOf(stays, what) ||
         std::ranges::none_of(own.lost, [&stays](const std::string& lost) { return IsPartOf(stays, lost); });
}

/// "order 0" of "target dy order 0", beside "target dy".
std::string PartIn(const std::string& part, const std::string& what) {
  return part.starts_with(what + " ") ? part.substr(what.size() + 1) : part;
}

}  // namespace

std::vector<std::string> MendedBy(const Outlook& own, const Outlook& other) {
  if (!other.separates) return {};
  return Without(own.lost, other.lost);
}

std::vector<std::string> MendedInWords(const Outlook& own, const Outlook& other) {
  std::vector<std::string> words;
  const std::vector<std::string>& lost = other.lost;
  for (const std::string& what : MendedBy(own, other)) {
    if (std::ranges::any_of(lost, [&what](const std::string& more) { return IsPartOf(what, more); })) continue;
    std::vector<std::string> stays;
    for (const std::string& part : lost) {
      if (StaysOf(own, part, what)) stays.push_back(PartIn(part, what));
    }
    words.push_back(stays.empty() ? what : fmt::format("{} but for {}", what, fmt::join(stays, "; ")));
  }
  return words;
}

std::vector<std::string> WhollyMendedBy(const Outlook& own, const Outlook& other, const Outlook& good) {
  std::vector<std::string> mended = MendedBy(own, other);
  const std::vector<std::string> stays = Without(other.lost, good.lost);
  std::erase_if(mended, [&](const std::string& what) {
    return std::ranges::any_of(stays, [&](const std::string& part) { return StaysOf(own, part, what); });
  });
  return mended;
}

}  // namespace twinbench::plan
