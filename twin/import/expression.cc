#include "twin/import/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include "twin/core/errors.h"
#include "twin/core/units.h"
#include "twin/import/column_functions.h"

namespace twinbench::imports {

struct Expression::Node {
  enum class Kind { kNumber, kName, kCall };
  Kind kind = Kind::kNumber;
  double number = 0.0;
  std::string text;  // a name, or what is called: "+", "sin", ...
  std::vector<std::unique_ptr<Node>> arguments;
};

namespace {

using Node = Expression::Node;
using NodePtr = std::unique_ptr<Node>;
using One = double (*)(double);
using Two = double (*)(double, double);

template <class Function>
struct Named {
  std::string_view name;
  Function function;
};

constexpr std::array kOne = std::to_array<Named<One>>({{"sin", [](double x) { return std::sin(x); }},
                                                       {"cos", [](double x) { return std::cos(x); }},
                                                       {"tan", [](double x) { return std::tan(x); }},
                                                       {"asin", [](double x) { return std::asin(x); }},
                                                       {"acos", [](double x) { return std::acos(x); }},
                                                       {"atan", [](double x) { return std::atan(x); }},
                                                       {"sqrt", [](double x) { return std::sqrt(x); }},
                                                       {"abs", [](double x) { return std::abs(x); }},
                                                       {"sind", [](double x) { return std::sin(x * units::deg); }},
                                                       {"cosd", [](double x) { return std::cos(x * units::deg); }},
                                                       {"negate", [](double x) { return -x; }}});
constexpr std::array kTwo =
    std::to_array<Named<Two>>({{"+", [](double a, double b) { return a + b; }},
                               {"-", [](double a, double b) { return a - b; }},
                               {"*", [](double a, double b) { return a * b; }},
                               {"/", [](double a, double b) { return a / b; }},
                               {"^", [](double a, double b) { return std::pow(a, b); }},
                               {"atan2", [](double a, double b) { return std::atan2(a, b); }},
                               {"only", [](double a, double b) { return a <= b ? 0.0 : std::nan(""); }},
                               {"min", [](double a, double b) { return std::min(a, b); }},
                               {"max", [](double a, double b) { return std::max(a, b); }}});

template <class Table>
auto Find(const Table& table, std::string_view name) {
  const auto found = std::ranges::find_if(table, [name](const auto& entry) { return entry.name == name; });
  return found == table.end() ? nullptr : &*found;
}

std::size_t ArgumentsOf(std::string_view function) {
  if (function == "before" || ColumnFunction(function) || Find(kOne, function)) return 1;
  return function == "is" || ColumnsFunction(function) || Find(kTwo, function) ? 2 : 0;
}

/// Recursive descent: sum, product, power, atom.
class Parser {
 public:
  Parser(const std::string& text, const std::string& where) : text_(text), where_(where) {}

  NodePtr Whole() {
    NodePtr node = Sum();
    if (Peek() != '\0') Refuse();
    return node;
  }

 private:
  [[noreturn]] void Refuse() const {
    const std::string rest = text_.substr(std::min(at_, text_.size()));
    throw InputError(
        where_, rest.empty() ? fmt::format("\"{}\" ends where more is needed", text_) : fmt::format("\"{}\" cannot be read from \"{}\" on", text_, rest),
        "columns (in [ ] if their names have blanks or signs), numbers, + - * / ^ and functions such as "
        "atan2(a, b)");
  }

  char Peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool Take(char c) {
    if (Peek() != c) return false;
    ++at_;
    return true;
  }

  static NodePtr Call(std::string name, NodePtr a, NodePtr b = nullptr) {
    auto node = std::make_unique<Node>();
    node->kind = Node::Kind::kCall;
    node->text = std::move(name);
    node->arguments.push_back(std::move(a));
    if (b) node->arguments.push_back(std::move(b));
    return node;
  }

  NodePtr Sum() {
    NodePtr left = Product();
    for (;;) {
      if (Take('+')) {
        left = Call("+", std::move(left), Product());
      } else if (Take('-')) {
        left = Call("-", std::move(left), Product());
      } else {
        return left;
      }
    }
  }

  NodePtr Product() {
    NodePtr left = Sign();
    for (;;) {
      if (Take('*')) {
        left = Call("*", std::move(left), Sign());
      } else if (Take('/')) {
        left = Call("/", std::move(left), Sign());
      } else {
        return left;
      }
    }
  }

  NodePtr Sign() {
    if (Take('-')) return Call("negate", Sign());
    if (Take('+')) return Sign();
    NodePtr base = Atom();
    return Take('^') ? Call("^", std::move(base), Sign()) : std::move(base);
  }

  NodePtr Atom() {
    const char c = Peek();
    if (Take('(')) {
      NodePtr inside = Sum();
      if (!Take(')')) Refuse();
      return inside;
    }
    if (c == '[') return Bracketed();
    if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') return Number();
    if (std::isalpha(static_cast<unsigned char>(c)) || c == '_' || (c & 0x80)) return NameOrCall();
    Refuse();
  }

  /// A name may have brackets of its own: "[Measured Z [m] - Run 1]".
  NodePtr Bracketed() {
    std::size_t end = at_;
    for (int open = 0; end < text_.size(); ++end) {
      open += text_[end] == '[' ? 1 : text_[end] == ']' ? -1 : 0;
      if (open == 0) break;
    }
    if (end == text_.size()) Refuse();
    auto node = std::make_unique<Node>();
    node->kind = Node::Kind::kName;
    node->text = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return node;
  }

  NodePtr Number() {
    auto node = std::make_unique<Node>();
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), node->number);
    if (error != std::errc()) Refuse();
    at_ = static_cast<std::size_t>(end - text_.data());
    return node;
  }

  NodePtr NameOrCall() {
    const auto part_of_name = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == ':' || (c & 0x80);
    };
    const std::size_t begin = at_;
    while (at_ < text_.size() && part_of_name(text_[at_])) ++at_;
    auto node = std::make_unique<Node>();
    node->text = text_.substr(begin, at_ - begin);
    node->kind = Node::Kind::kName;
    if (Peek() != '(' || ArgumentsOf(node->text) == 0) return node;
    ++at_;
    node->kind = Node::Kind::kCall;
    do node->arguments.push_back(Sum());
    while (Take(','));
    if (!Take(')') || node->arguments.size() != ArgumentsOf(node->text)) Refuse();
    return node;
  }

  const std::string& text_;
  const std::string& where_;
  std::size_t at_ = 0;
};

void CollectNames(const Node& node, std::vector<std::string>& names) {
  if (node.kind == Node::Kind::kName && std::ranges::find(names, node.text) == names.end())
    names.push_back(node.text);
  const bool second_is_a_word = node.kind == Node::Kind::kCall && node.text == "is";
  for (std::size_t i = 0; i < node.arguments.size(); ++i) {
    if (!(second_is_a_word && i == 1)) CollectNames(*node.arguments[i], names);
  }
}

class Evaluator {
 public:
  Evaluator(std::size_t rows, const std::function<Values(const std::string&)>& look_up, const std::string& where)
      : rows_(rows), look_up_(look_up), where_(where) {}

  std::vector<double> Of(const Node& node) const {
    if (node.kind == Node::Kind::kNumber) return {node.number};
    if (node.kind == Node::Kind::kName) return Number(node);
    if (node.text == "is") return Is(node);
    if (node.text == "before") return Before(node);
    std::vector<double> a = Of(*node.arguments[0]);
    if (const OfColumn function = ColumnFunction(node.text)) return function(std::move(a), where_);
    if (const OfColumns function = ColumnsFunction(node.text)) return function(a, Of(*node.arguments[1]), where_);
    if (const auto* one = Find(kOne, node.text)) {
      std::ranges::transform(a, a.begin(), one->function);
      return a;
    }
    return Combine(Find(kTwo, node.text)->function, std::move(a), Of(*node.arguments[1]));
  }

 private:
  std::vector<double> Number(const Node& node) const {
    Values values = look_up_(node.text);
    if (values.words)
      throw InputError(where_, fmt::format("\"{}\" holds words and no numbers", node.text), "is(column, word)");
    return std::move(values.value);
  }

  static std::vector<double> Combine(Two function, std::vector<double> a, const std::vector<double>& b) {
    if (a.size() == 1 && b.size() > 1) a.assign(b.size(), a[0]);
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = function(a[i], b.size() == 1 ? b[0] : b[i]);
    return a;
  }

  std::vector<double> Before(const Node& node) const {
    std::vector<double> x = Of(*node.arguments[0]);
    if (x.size() == 1) x.assign(rows_, x[0]);
    double sum = 0.0;
    for (double& value : x) {
      const double own = value;
      value = sum;
      if (std::isfinite(own)) sum += own;
    }
    return x;
  }

  std::vector<double> Is(const Node& node) const {
    const Values values = look_up_(node.arguments[0]->text);
    const std::string& word = node.arguments[1]->text;
    std::vector<double> is(values.value.size(), 0.0);
    if (!values.words) return is;  // a column without a single word
    for (std::size_t i = 0; i < is.size(); ++i) {
      const double number = values.value[i];
      if (std::isfinite(number) && (*values.words)[static_cast<std::size_t>(number)] == word) is[i] = 1.0;
    }
    return is;
  }

  std::size_t rows_;
  const std::function<Values(const std::string&)>& look_up_;
  const std::string& where_;
};

}  // namespace

Expression::Expression(const std::string& text, const std::string& where) : where_(where) {
  root_ = Parser(text, where_).Whole();
  CollectNames(*root_, names_);
}
Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;

std::vector<double> Expression::Evaluate(std::size_t rows,
                                         const std::function<Values(const std::string&)>& look_up) const {
  std::vector<double> value = Evaluator(rows, look_up, where_).Of(*root_);
  if (value.size() == 1 && rows != 1) value.assign(rows, value[0]);
  return value;
}

}  // namespace twinbench::imports
