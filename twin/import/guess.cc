#include "twin/import/guess.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "twin/core/errors.h"
#include "twin/import/common.h"
#include "twin/import/join.h"

namespace twinbench::imports {
namespace {

/// What a reference, and what a device under test is called, the clearest first.
const std::vector<std::vector<std::string>> kWords = {
    {"reference", "ref", "true", "laser", "interferometer", "truth", "target", "commanded", "command", "cmd",
     "setpoint", "posset", "setpos", "set", "nominal", "desired", "soll", "motor", "poscmd"},
    {"measured", "device", "dut", "encoder", "sensor", "actual", "actpos", "posact", "resolver", "feedback", "fb",
     "act", "position", "ist", "reading", "angle", "load", "enc"}};

/// The words of a name: "MAIN.fActPos" has "main", "f", "act", "pos", and "actpos" as a whole part.
std::set<std::string> WordsOf(const std::string& name) {
  std::set<std::string> words;
  std::string word, part;
  const auto end_word = [&] {
    if (!word.empty()) words.insert(SmallLetters(word));
    word.clear();
  };
  const auto end_part = [&] {
    end_word();
    if (part.size() > 2) words.insert(SmallLetters(part));
    part.clear();
  };
  for (const char c : name) {
    if (!std::isalpha(static_cast<unsigned char>(c))) {
      end_part();
      continue;
    }
    if (std::isupper(static_cast<unsigned char>(c)) && !word.empty() &&
        std::islower(static_cast<unsigned char>(word.back())))
      end_word();
    word += c;
    part += c;
  }
  end_part();
  return words;
}

struct Choice {
  std::string name;  // as an expression has it
  const Column* column = nullptr;
};

/// Columns of numbers, each under a name that is its own.
std::vector<Choice> NumberColumns(const std::vector<Recording>& recordings) {
  std::vector<Choice> all;
  for (const Recording& recording : recordings) {
    for (const Track& track : recording.tracks) {
      for (const Column& column : track.columns) {
        const bool again =
            std::ranges::find(all, column.name, [](const Choice& c) { return c.column->name; }) != all.end();
        if (column.IsNumber() && !(again && (recording.parts_are_setups || recordings.size() > 1)))
          all.push_back({column.name, &column});
      }
    }
  }
  return all;
}

/// A column that never changes is nobody's reference and no device: it is not guessed to be one.
bool Changes(const Choice& choice) {
  return std::ranges::any_of(choice.column->value, [&](double x) { return x != choice.column->value[0]; });
}

bool IsGiven(const Map& map, const std::string& column) {
  return std::ranges::any_of(map.columns, [&column](const MappedColumn& c) { return c.column == column; });
}

/// A unit that can stand for the column's, or nothing.
std::string UnitFor(const Column& column, const std::string& target) {
  const auto wanted = UnitAtEnd(target);
  const auto has = UnitNamed(column.unit);
  if (!wanted || !has) return "";
  const bool fits = has->dimension == wanted->dimension ||
                    (wanted->dimension == Dimension::kAngle && has->dimension == Dimension::kLength);
  return fits ? std::string(has->name) : "";
}

void Put(const std::string& target, const Choice& from, const std::string& why, Map& map,
         std::vector<std::string>& remarks) {
  const std::string own = UnitFor(*from.column, target);
  const auto wanted = UnitAtEnd(target);
  const std::string unit = !own.empty() ? own : wanted ? std::string(wanted->name) : "";
  map.columns.push_back({target, from.name, unit, ""});
  std::string line = fmt::format("{} is taken from \"{}\"", target, from.name);
  if (!why.empty()) line += ", " + why;
  if (own.empty() && wanted) line += fmt::format("; its unit is not said and taken as {}", unit);
  if (!why.empty() || own.empty()) remarks.push_back(line);
}

/// Numbers in a list: whole, without a unit, fewer than rows. "Position [deg]" is where a device says that it stands.
bool IsLabel(const Column& column) {
  const double rows = static_cast<double>(column.value.size());
  return column.unit.empty() && std::ranges::all_of(column.value, [rows](double x) {
    return std::isnan(x) || (x == std::round(x) && std::abs(x) < rows);
  });
}

/// Columns that are called as the bench calls them, in any unit.
void TakeNamesakes(const std::vector<Choice>& columns, const BenchFormat& bench, Map& map) {
  std::vector<std::string> none;
  for (const ReadingColumn& target : bench.columns) {
    const bool common =
        target.name == "setup" || target.name == "pass" || target.name == "direction" || target.name == "position";
    if (IsGiven(map, target.name) || (!target.number && !common)) continue;
    const auto found = std::ranges::find_if(columns, [&](const Choice& c) {
      if (common && !IsLabel(*c.column)) return false;
      return c.name == target.name || SmallLetters(c.name) == BaseOf(target.name) ||
             BaseOf(c.name) == BaseOf(target.name);
    });
    if (found != columns.end()) Put(target.name, *found, "", map, none);
  }
}

/// How clearly a name speaks of one of the words: the earlier in the list the better; 0: not at all.
int Clearness(const std::string& name, const std::vector<std::string>& words) {
  const std::set<std::string> own = WordsOf(name);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (own.contains(words[i])) return static_cast<int>(words.size() - i);
  }
  return 0;
}

const Choice* Clearest(const std::vector<Choice>& columns, const std::vector<std::string>& words,
                       const std::set<std::string>& taken) {
  const Choice* best = nullptr;
  int clearness = 0;
  for (const Choice& column : columns) {
    const int own = taken.contains(column.name) ? 0 : Clearness(column.name, words);
    if (own > clearness) {
      clearness = own;
      best = &column;
    }
  }
  return best;
}

std::set<std::string> Taken(const Map& map) {
  std::set<std::string> taken;
  for (const MappedColumn& column : map.columns) taken.insert(column.expression);
  return taken;
}

}  // namespace

void FillIn(const std::vector<Recording>& recordings, const BenchFormat& bench,
            const std::vector<std::string>& compared, Map& map, std::vector<std::string>& remarks) {
  std::vector<Choice> columns = NumberColumns(recordings);
  TakeNamesakes(columns, bench, map);
  std::erase_if(columns, [](const Choice& choice) { return !Changes(choice); });
  for (std::size_t k = 0; k < compared.size(); ++k) {
    if (IsGiven(map, compared[k])) continue;
    if (const Choice* found = Clearest(columns, kWords[k], Taken(map)))
      Put(compared[k], *found, "by its name", map, remarks);
  }
  for (std::size_t k = 0; k < compared.size(); ++k) {
    if (IsGiven(map, compared[k])) continue;
    const std::set<std::string> taken = Taken(map);
    std::vector<Choice> left;
    std::ranges::copy_if(columns, std::back_inserter(left),
                         [&taken](const Choice& c) { return !taken.contains(c.name); });
    const std::size_t missing = static_cast<std::size_t>(
        std::ranges::count_if(compared, [&map](const auto& c) { return !IsGiven(map, c); }));
    if (left.size() == missing) {
      Put(compared[k], left[0], "the first column that is left", map, remarks);
      continue;
    }
    throw InputError(
        recordings[0].file,
        fmt::format("which column is {} is not clear; there are {}", compared[k], ColumnNames(recordings)),
        fmt::format("{} = \"a column\" under [columns] of a map, or --column '{}=a column'", compared[k],
                    compared[k]));
  }
}

const BenchFormat& BenchFor(const std::vector<Recording>& recordings, const Map& map) {
  if (!map.bench.empty()) return FormatOf(map.bench);
  const BenchFormat* by_name = FormatByColumns([&](const ReadingColumn& column) {
    if (IsGiven(map, column.name)) return true;
    return std::ranges::any_of(recordings, [&column](const Recording& recording) {
      return std::ranges::any_of(recording.tracks, [&column](const Track& track) {
        return std::ranges::any_of(track.columns, [&column](const Column& c) { return c.name == column.name; });
      });
    });
  });
  if (by_name) return *by_name;
  const auto compares =
      std::ranges::find_if(BenchFormats(), [](const BenchFormat* f) { return f->compared.has_value(); });
  if (compares != BenchFormats().end()) return **compares;
  throw InputError(recordings[0].file, "the columns are those of no known bench", "bench = ... in a map");
}

}  // namespace twinbench::imports
