#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "twin/import/recording.h"

/// How a quantity of the bench comes from the columns of a file: "encoder * 360 / 4096".
///
/// Numbers, + - * / ^ and parentheses; names of columns as they are, or in brackets where they have blanks or
/// signs: [Axis 1.ActPos]; numbers from the text above a table by their names; `index` (0, 1, ...), `count` (rows),
/// `time_s`. Functions: sin cos tan asin acos atan atan2 sqrt abs (angles in rad), sind cosd (in deg), min max,
/// before(x), the sum of x over all earlier rows; turns(x), x by its turn where x goes round once, in whatever
/// unit; correction(x), an error by its turn, x in rad or in 16 bit about 32768; is(column, word), 1 where the
/// column has the word, else 0; parts(x), how often x was another than in the row before; step(x), x less that of
/// the row before; sense(x), +1 or -1 as x in deg goes on; whole(x), the middle one of all x to one part in a
/// thousand; middle(x) and span(x), of the lowest and the highest x; only(a, b), 0 where a is not above b, else no
/// number; distinct(x), how many different values x has; seats(x), how many places evenly round a turn x in deg is
/// of; places(x), the number of each angle in deg as they lie round the circle; unwrapped(x) of an angle in deg
/// that starts again at a turn, within_turn(x) of one that goes on; ratio(a, b), how far a goes with b; whole_turns(a, b), the
/// smallest number of turns of a that is a whole number of turns of b; stated_ratio(a, b), a or its inverse, as the ratio b
/// has it; beside(a, b), a less b where they go together one to one, else a; scatter(x, group), the standard deviation of x among rows
/// of the same group, 0 where none has two.
///
/// Written here because no such library is among the packages that the program needs, and columns of a million rows
/// are to go through it as a whole.
namespace twinbench::imports {

/// What a name stands for; a single number stands for all rows.
struct Values {
  std::vector<double> value;
  const std::vector<std::string>* words = nullptr;  // of a column of words
};

class Expression {
 public:
  /// @param where  For messages.
  /// @throws InputError if the text is no expression.
  Expression(const std::string& text, const std::string& where);
  ~Expression();
  Expression(Expression&&) noexcept;

  /// Every name in it, each once.
  const std::vector<std::string>& Names() const { return names_; }

  /// @param look_up  What a name stands for on the rows in hand.
  /// @return one value a row.
  /// @throws InputError if a word is used as a number, or no unit is known of which turns(x) has one turn.
  std::vector<double> Evaluate(std::size_t rows, const std::function<Values(const std::string&)>& look_up) const;

  struct Node;

 private:
  std::string where_;
  std::vector<std::string> names_;
  std::unique_ptr<Node> root_;
};

}  // namespace twinbench::imports
