#pragma once

#include <vector>

#include "twin/diagnose/screen/sample.h"
#include "twin/diagnose/screen/screen.h"

/// The tests of the screen, a group a file; each returns those of its group that apply to the run.
namespace twinbench::diagnose::screen {

using Tests = std::vector<ScreenTest>;

Tests TestFit(const Sample& sample);           // against the stated noise, and against repeats
Tests TestNoiseScale(const Sample& sample);    // by channel, by spot, by distance of the spot from the centre
Tests TestTails(const Sample& sample);         // Student's t, single outliers
Tests TestWhiteness(const Sample& sample);     // products of neighbours within a pass
Tests TestTime(const Sample& sample);          // wander, drift, creep, warm-up
Tests TestSteps(const Sample& sample);         // onset scan
Tests TestCusum(const Sample& sample);         // running sum
Tests TestAveraging(const Sample& sample);     // Allan deviation of readings in a row
Tests TestTones(const Sample& sample);         // frequency scan
Tests TestHarmonics(const Sample& sample);     // of each angle and of the sum, difference, half turns
Tests TestLock(const Sample& sample);          // harmonics by set-up, and what they are locked to
Tests TestDirection(const Sample& sample);     // mean, harmonics, dwell, speed
Tests TestGroups(const Sample& sample);        // variance components: set-up, pass, place
Tests TestTemperature(const Sample& sample);   // behind a first-order lag, and its rate
Tests TestSpot(const Sample& sample);          // Legendre polynomials and periods of the spot's coordinates
Tests TestSpotMap(const Sample& sample);       // cells of the detector
Tests TestPatterns(const Sample& sample);      // which body moves
Tests TestChannelOrder(const Sample& sample);  // what the channel before leaves behind

}  // namespace twinbench::diagnose::screen
