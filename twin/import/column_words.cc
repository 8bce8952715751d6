#include "twin/import/column_words.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>

#include "twin/import/common.h"
#include "twin/import/text.h"
#include "twin/import/unit_names.h"

namespace twinbench::imports {
namespace {

constexpr int kMostOfOneSide = 100;  // of one side in a name: how many there are counts behind how clear they are

/// The clearest first.
const std::vector<std::string>& WordsFor(Speaks of) {
  static const std::vector<std::string> reference = {
      "reference", "ref",      "true",     "laser",    "interferometer", "truth",        "target",     "setpoint",   "set point",
      "commanded", "command",  "cmd",      "posset",   "setpos",         "set",          "goal",       "nominal",
      "nom",       "calibrated", "certified", "desired",  "des",      "demand",   "demanded",       "soll",         "sollwert",   "sollposition",
      "sollwinkel", "referenz", "consigne", "consigna", "cible",          "référence",    "referencia", "riferimento",
      "comando",   "zadana",   "эталон",   "задание",  "目标",           "指令",         "参考",       "motor",
      "poscmd",    "referência", "desejado", "alvo",    "gewenst",        "doel",         "börvärde",  "hedef",
      "zadaný",    "目標",     "rsol",     "aspos",    "ordered",      "order",      "given",    "noml",    "lagesollwert"};
  static const std::vector<std::string> device = {
      "measured", "meas",     "device",   "dut",      "encoder",     "sensor",    "actual",    "actpos",  "posact",
      "present",  "resolver", "feedback", "fb",       "fbk",         "act",       "dial",      "gauge",   "indicator",
      "messuhr",  "settled",  "reached", "arrived", "counts",  "ticks",  "raw", "position", "ist",      "istwert",  "istposition", "istwinkel", "messwert",  "gemessen", "mesure",
      "mesuré",   "medido",   "medida",   "misurato", "misura",      "zmierzona", "измерено",  "实际",    "测量",
      "反馈",     "编码器",   "reading",  "angle",    "enc",         "probe",     "pos",       "load",
      "saída",     "saida",    "gemeten",  "ärvärde",     "uppmätt",     "ölçülen",   "zmierzone", "měřeno",    "測定",
      "output",    "rist",     "aipos",    "real",      "process value",        "lageistwert"};
  return of == Speaks::kReference ? reference : device;
}

bool IsPartOfWord(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80;
}

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
    if (!IsPartOfWord(c)) {
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

/// Words of scripts without blanks between them stand anywhere in a name; of several words all have to be there.
bool Has(const std::set<std::string>& own, const std::string& name, const std::string& word) {
  if (const std::size_t blank = word.find(' '); blank != std::string::npos)
    return own.contains(word.substr(0, blank)) && Has(own, name, word.substr(blank + 1));
  const bool is_foreign = static_cast<unsigned char>(word[0]) >= 0xE0;
  return own.contains(word) || (is_foreign && name.find(word) != std::string::npos);
}

template <std::size_t n>
bool HasAny(const std::string& name, const std::array<const char*, n>& words) {
  const std::set<std::string> own = WordsOf(name);
  return std::ranges::any_of(words, [&](const char* word) { return own.contains(word); });
}

}  // namespace

int Clearness(const std::string& name, Speaks of) {
  return ClearnessBy(name, WordsFor(of));
}

std::string BareName(const std::string& name) {
  std::string bare = SmallLetters(UnitAtEnd(name) ? name.substr(0, name.rfind('_')) : name);
  std::ranges::replace(bare, '_', ' ');
  return bare;
}

int ClearnessBy(const std::string& name, const std::vector<std::string>& words) {
  const std::set<std::string> own = WordsOf(name);
  const std::string small = SmallLetters(name), bare = BareName(name);
  int clearest = 0, count = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!Has(own, name, words[i]) && small != words[i] && bare != words[i]) continue;
    ++count;
    if (clearest == 0) clearest = static_cast<int>(words.size() - i);
  }
  return kMostOfOneSide * clearest + count;
}

bool IsCalledError(const std::string& name) {
  return HasAny(name, std::array{"error", "err", "errors", "deviation", "dev", "abweichung", "fehler", "residual", "diff",
                                 "difference", "erreur", "écart", "desviación", "offset", "offsets", "residuum", "residuals", "erro", "fout", "błąd", "hata", "te"}) ||
         IsCalledCorrection(name);
}

bool IsCalledCommand(const std::string& name) {
  return HasAny(name, std::array{"target", "commanded", "command", "cmd", "setpoint", "posset", "setpos", "goal", "desired", "des", "demand", "demanded",
                                 "soll", "sollwert", "sollposition", "sollwinkel", "consigne", "consigna", "poscmd", "comando", "ordered", "given", "noml", "lagesollwert"});
}

bool AreOfTwoAxes(const std::string& a, const std::string& b) {
  const auto axis_in = [](const std::string& name) -> std::string {
    const std::set<std::string> own = WordsOf(name);
    for (const char* axis : {"roll", "pitch", "yaw", "pan", "tilt", "azimuth", "elevation", "az", "el"}) {
      if (own.contains(axis)) return axis;
    }
    return "";
  };
  const std::string of_a = axis_in(a), of_b = axis_in(b);
  return !of_a.empty() && !of_b.empty() && of_a != of_b;
}

bool SaysOnlyPlace(const std::string& name) {
  return Clearness(name, Speaks::kReference) == 0 && Clearness(name, Speaks::kDevice) % kMostOfOneSide == 1 && HasAny(name, std::array{"angle", "position", "pos"});
}

bool SaysNothing(const std::string& name) {
  static const std::set<std::string> kAnything = {"column", "col", "channel", "chan", "var", "field", "data", "value", "values", "signal", "trace", "entry", "list", "array", "series", "unnamed", "ch"};
  return std::ranges::all_of(WordsOf(name), [](const std::string& word) { return kAnything.contains(word); });
}

bool SpeaksOfSide(const std::string& word) {
  return Clearness(word, Speaks::kReference) > 0 || Clearness(word, Speaks::kDevice) > 0 || IsCalledPlace(word) ||
         HasAny(word, std::array{"state", "status", "given", "deg", "rad"});
}

bool IsCalledCorrection(const std::string& name) {
  return HasAny(name, std::array{"correction", "corrections", "corr", "korrektur", "compensation", "kompensation", "corrección"});
}

bool IsCalledDirection(const std::string& name) {
  return HasAny(name, std::array{"direction", "dir", "sense", "approach", "richtung", "side", "sens", "dirección"});
}

bool IsCalledSetup(const std::string& name) {
  return HasAny(name, std::array{"setup", "session", "mounting", "clamping", "aufspannung"});
}

int TurnIn(const std::string& text) {
  std::string small = SmallLetters(text);
  const auto take = [&small](const auto& words) {
    bool found = false;
    for (const std::string_view word : words) {
      for (std::size_t at = 0; (at = small.find(word, at)) != std::string::npos;) {
        const auto is_letter = [&](std::size_t i) { return i < small.size() && (IsPartOfWord(small[i]) || std::isdigit(static_cast<unsigned char>(small[i]))); };
        const bool whole = static_cast<unsigned char>(word[0]) >= 0x80 || (!(at > 0 && is_letter(at - 1)) && !is_letter(at + word.size()));
        if (!whole) {
          at += word.size();
          continue;
        }
        small.replace(at, word.size(), " ");
        found = true;
      }
    }
    return found;
  };
  // The longer ones first: what is taken is not looked at again.
  const bool counter = take(std::array<std::string_view, 20>{"counter-clockwise", "counter clockwise", "counterclockwise", "anti-clockwise", "anticlockwise", "ccw", "acw",
                                  "gegen den uhrzeigersinn", "gegen uhrzeigersinn", "gegenuhrzeigersinn", "linkslauf", "g03", "g3", "逆时针",
                                  "antihoraire", "anti-horaire", "trigonométrique", "antihorario", "antiorario", "entgegen uhrzeigersinn"});
  const bool clockwise = take(std::array<std::string_view, 11>{"clockwise", "cw", "im uhrzeigersinn", "uhrzeigersinn", "rechtslauf", "g02", "g2", "顺时针", "horaire", "horario", "orario"});
  return counter == clockwise ? 0 : counter ? 1 : -1;
}

int DirectionOfWord(std::string_view word) {
  const std::string small = SmallLetters(Trimmed(word));
  const auto is_one_of = [&small](const auto& words) { return std::ranges::find(words, small) != words.end(); };
  if (is_one_of(std::array{"+", "forward", "fwd", "up", "positive", "pos", "ccw", "vor", "vorwärts", "auf", "right", "rechts",
                           "plus", "f", "↑", "→", "increasing"}))
    return 1;
  if (is_one_of(std::array{"-", "−", "backward", "backwards", "bwd", "back", "down", "negative", "neg", "cw", "reverse", "rev",
                           "zurück", "rückwärts", "ab", "left", "links", "minus", "b", "r", "↓", "←", "decreasing"}))
    return -1;
  return TurnIn(small);
}

bool IsCalledTemperature(const std::string& name) {
  return name.starts_with("T_") || name.starts_with("T ") ||
         HasAny(name, std::array{"temperature", "temp", "temperatur", "température", "temperatura", "температура", "sıcaklık", "temperatuur"});
}

bool IsOtherQuantity(const Column& column) {
  for (const std::string_view end : {"_A", "_mA", "_V", "_mV", "_W", "_Nm", "_N", "_Hz", "_pct", "_hPa", "_K"}) {
    if (column.name.ends_with(end)) return true;
  }
  const auto unit = UnitNamed(column.unit);
  if (unit) return unit->dimension != Dimension::kAngle && unit->dimension != Dimension::kLength;
  if (column.unit.find("/s") != std::string::npos || column.unit.find("/min") != std::string::npos) return true;
  for (const std::string_view other : {"A", "mA", "Hz", "Nm", "%", "N", "W"}) {
    if (column.unit == other) return true;
  }
  if (IsCalledTemperature(column.name) || IsRate(column)) return true;
  return HasAny(column.name, std::array{"torque", "tor", "trq", "tau", "effort", "efforts", "voltage", "volt", "volts", "current", "amp", "amps", "kp", "ki", "kd",
                                        "acceleration", "acc", "pwm", "humidity", "pressure", "stamp", "timestamp", "secs", "nsecs"}) &&
         !IsCalledPlace(column.name);
}

bool IsRate(const Column& column) {
  if (const auto unit = UnitNamed(column.unit)) return unit->dimension == Dimension::kSpeed || unit->dimension == Dimension::kTurning;
  const bool is_of_shaft = HasAny(column.name, std::array{"high", "low"});  // "high speed" is the fast one of a gear
  return !is_of_shaft && !IsCalledPlace(column.name) &&
         HasAny(column.name, std::array{"velocity", "vel", "speed", "rate", "rates", "gyro", "omega", "rpm", "dq", "qd", "dot", "geschwindigkeit", "drehzahl"});
}

bool IsCalledJoint(const std::string& name) {
  return HasAny(name, std::array{"q"});
}

bool IsCalledPlace(const std::string& name) {
  return HasAny(name, std::array{"position", "pos", "angle", "encoder", "enc"}) || IsCalledJoint(name);
}

bool IsCalledLength(const std::string& name) {
  return HasAny(name, std::array{"distance", "dist", "displacement", "stroke", "extension", "elongation", "height", "length", "abstand", "distancia", "distanza"}) &&
         !HasAny(name, std::array{"angle", "angular", "deg", "rad"});
}

bool IsNoUnit(const std::string& unit) {
  const std::string small = SmallLetters(unit);
  return std::ranges::any_of(std::array{"", "-", "1", "none", "(none)", "a.u.", "?"},
                             [&small](const char* none) { return small == none; });
}

}  // namespace twinbench::imports
