#include "twin/benches/certified_parts.h"

#include <algorithm>
#include <vector>

#include "twin/core/errors.h"

namespace twinbench::benches {
namespace {

using certificate::CertifiedBench;

const std::vector<CertifiedBench>& All() {
  static const std::vector<CertifiedBench> all = {
      {"rotary_4dof",
       "Four-degree-of-freedom measurement with a laser, a diffraction grating on a reference table and two position-sensitive detectors, after "
       "Jywe et al., Int. J. Machine Tools & Manufacture 47 (2007) 1978-1987; errors of both tables from shifted full-circle tests",
       {{"separation.target", "target", "table under test", ""}, {"separation.reference", "reference", "reference table", ""},
        {"iso230_7[].values", "", "error motion", "ISO 230-7"}}},
      {"turntable_autocollimator",
       "Comparison of a turntable with a multi-tooth table or a polygon by an autocollimator",
       {{"separation.turntable", "turntable", "turntable", ""},
        {"separation.multitooth", "multi-tooth table", "multi-tooth table", ""},
        {"separation.polygon", "polygon", "polygon", ""},
        {"iso230_7[].values", "turntable", "error motion", "ISO 230-7"}}},
      {"hob_transmission",
       "Comparison of the angles of hob spindle and worktable by ring encoders whose heads are read in several places",
       {{"separation.transmission[]", "transmission", "transmission chain", ""},
        {"separation.table_encoder", "table encoder", "table encoder", ""}}},
      {"circular_motion",
       "Circles of a machine tool under a telescoping bar that is read in length and angle",
       {{"iso230_4[]", "", "circular deviations", "ISO 230-4"}, {"errors", "", "error parameters", ""}}},
      {"freeform_five_axis",
       "Probing of an array of paraboloids on a five-axis machine; errors predicted at poses of the working volume",
       {{"error_map", "", "volumetric errors", ""}}},
      {"encoder_comparison",
       "Comparison of an angle device with a reference",
       {{"device", "device", "device", ""},
        {"reference", "reference", "reference", ""},
        {"harmonics.device[]", "device", "orders of the device", ""},
        {"harmonics.reference[]", "reference", "orders of the reference", ""},
        {"iso230_2[].axis", "", "positioning against the reference", "ISO 230-2"},
        {"vdi3441[].axis", "", "positioning against the reference, VDI/DGQ 3441", "VDI/DGQ 3441"}}}};
  return all;
}

}  // namespace

const CertifiedBench& CertifiedPartsOf(const std::string& bench, const std::string& where) {
  const auto found = std::ranges::find(All(), bench, &CertifiedBench::bench);
  if (found != All().end()) return *found;
  std::string names;
  for (const CertifiedBench& one : All()) names += (names.empty() ? "" : ", ") + one.bench;
  throw InputError(where, "a run of the bench \"" + bench + "\", of whose results none are known to be a calibration's", "a run of " + names);
}

}  // namespace twinbench::benches
