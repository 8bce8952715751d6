#include "tests/diagnose/encoder_record.h"

namespace twinbench::diagnose::encoder {
namespace {

using namespace lab;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Absolute encoders of 12 bits, some of which are read wrongly.

constexpr unsigned kBits = 12, kCodes = 1U << kBits;

unsigned ToGray(unsigned code) { return code ^ (code >> 1U); }
unsigned FromGray(unsigned gray) {
  for (unsigned shift = 1; shift < kBits; shift *= 2) gray ^= gray >> shift;
  return gray;
}

/// Two turns there and back in stops of a degree, off the axis by 0.02 deg.
/// @param read  What becomes of a code.
Row Coded(const std::string& name, const std::function<unsigned(unsigned code)>& read,
          const std::vector<Check>& checks) {
  return {name,
          [read](unsigned seed) {
            Noise noise(0.001, seed);
            return Listed({0.3, 1.0, 720, 2, 0.05, "sweep"}, [&](const Place& at) {
              const double angle_deg = at.deg + Sum({{1, 0.02, 30.0}}, at.deg) + noise(),
                           turns = std::floor(angle_deg / 360.0);
              const auto code = static_cast<unsigned>((angle_deg / 360.0 - turns) * kCodes);
              const double shown_deg = 360.0 * (read(code) + 0.5) / kCodes;
              return at.deg + std::remainder(shown_deg - at.deg, 360.0);
            });
          },
          checks,
          {81}};
}

/// It alone explains nearly all, and no order is put in its place.
std::vector<Check> Mostly(const testing::Matcher<std::string>& words) {
  return {Is(Verdict::kUnknown), Says(words), NotNamed({"periodic", "scale", "slip"}, 0.2)};
}

/// To and fro beside a reference that shows whole degrees only: the same at every pass.
Row BesideWholeDegrees(const std::string& name, const std::vector<Check>& checks) {
  return {name,
          [](unsigned seed) {
            const Swing swing{360.0, 40.0};
            Record record = Swung(swing, 0.0, 160.0, 0.05, 0.002, seed, [&](double t_s) {
              return swing.At(t_s) + Sum({{1, 0.05, 30.0}}, swing.At(t_s));
            });
            for (Reading& r : record.readings)
              r.reference_rad = std::round(r.reference_rad / units::deg) * units::deg;
            return record;
          },
          checks};
}

Rows CodeRows() {
  const auto without = [](unsigned bit) { return [=](unsigned code) { return code & ~(1U << bit); }; };
  return {
      Coded("ABitThatIsDeadIsThatBitAndNotItsOrders", without(5),
            Mostly(AllOf(HasSubstr("bit of a binary code that is wrong, worth 2.812 deg"),
                         HasSubstr("amplitude 2.8 deg")))),
      Coded("ABitWorthLessThanTheWayFromStopToStopIsFoundAsWell", without(3),
            Mostly(AllOf(HasSubstr("worth 0.7031 deg"), HasSubstr("amplitude 0.7 deg")))),
      Coded(
          "BitsThatAreExchangedAreBoth",
          [](unsigned code) { return (code & ~0x30U) | ((code & 0x10U) << 1U) | ((code & 0x20U) >> 1U); },
          Mostly(AllOf(HasSubstr("worth 1.406 deg"), HasSubstr("worth 2.812 deg")))),
      Coded(
          "ATrackOfAGrayCodeThatIsDeadIsThatTrack",
          [](unsigned code) { return FromGray(ToGray(code) & ~(1U << 6U)); },
          Mostly(HasSubstr("track of a Gray code that is wrong, worth 5.625 deg"))),
      OfCourse("AnOrderThatIsAPowerOfTwoIsNoBit", {0.3, 1.0, 720, 2, 0.05, "sweep"}, 0.01,
               [](const Place& at) {
                 return Sum({{4, 0.5, 20.0}}, at.deg);
               },
               {Named("periodic"), Says(Not(HasSubstr("code")))}),
      BesideWholeDegrees("AReferenceInWholeDegreesErrsByItsRoundingAndInNoOrders",
                         {NoneFrom(0.5), HasUnnamed(false)}),
      OfCourse("ARangeThatEndsBelowWhereTheShaftTurnsIsSaidWithItsEnd", {0.3, 3.0, 120, 4, 0.05, "sweep"}, 0.003,
               [](const Place& at) {
                 return std::min(at.deg + Sum({{1, 0.02, 30.0}}, at.deg), 311.3) - at.deg;
               },
               {Is(Verdict::kUnknown), Says(HasSubstr("range that ends at 311.3 deg, above")),
                Says(Not(HasSubstr("lost counts")))}),
      OfCourse(
          "ARangeThatBeginsAboveWhereTheShaftTurnsIsSaidWithItsBeginning", {0.3, 3.0, 120, 4, 0.05, "sweep"}, 0.003,
          [](const Place& at) { return std::max(at.deg, 42.0) - at.deg; },
          {Is(Verdict::kUnknown), Says(HasSubstr("range that ends at 4")), Says(HasSubstr("below which nothing"))}),
      OfCourse("CountsThatComeBackBesideAnEllipseAreNoScale", {0.3, 1.0, 720, 2, 0.05, "sweep"}, 0.004,
               [](const Place& at) {
                 return Sum({{2, 0.03, 20.0}}, at.deg) - 0.05 * std::floor((at.deg - 123.4) / 360.0);
               },
               {NotNamed({"scale"}), Says(HasSubstr("deg is passed, which come back")), Order(2, 0.03, 0.001)}),
      // Behind the last jump there is one reading, where the course turns.
      OfCourse("ATurnThatIsPutRightAtZeroIsSaidToBeSoWhereTheCourseTurnsToo", {0.3, 1.0, 721, 2, 0.05, "sweep"},
               0.01, [](const Place& at) { return -8e-4 * (at.deg - 360.0 * std::floor(at.deg / 360.0)); },
               {Is(Verdict::kUnknown), Says(HasSubstr("turn that is not whole and put right at 359.7 deg")),
                NotNamed({"outliers", "eccentricity"})})};
}
INSTANTIATE_TEST_SUITE_P(Codes, EncoderAnswer, testing::ValuesIn(CodeRows()), NameOfRow);

}  // namespace
}  // namespace twinbench::diagnose::encoder
