#pragma once

#include "twin/diagnose/screen/sample.h"
#include "twin/diagnose/screen/significance.h"

/// The tests of the screen; each adds those of its group that apply to the run.
namespace twinbench::diagnose::screen {

void TestFit(const Sample& sample, Tests& tests);           // against the stated noise, and against repeats
void TestNoiseScale(const Sample& sample, Tests& tests);    // by channel, by spot, by distance from the centre
void TestTails(const Sample& sample, Tests& tests);         // Student's t, single outliers
void TestWhiteness(const Sample& sample, Tests& tests);     // products of neighbours within a pass
void TestTime(const Sample& sample, Tests& tests);          // wander, drift, creep, warm-up
void TestSteps(const Sample& sample, Tests& tests);         // onset scan
void TestCusum(const Sample& sample, Tests& tests);         // running sum
void TestTones(const Sample& sample, Tests& tests);         // frequency scan
void TestAveraging(const Sample& sample, Tests& tests);     // Allan deviation of readings in a row
void TestHarmonics(const Sample& sample, Tests& tests);     // of each angle and of the sum, difference, half turns
void TestLock(const Sample& sample, Tests& tests);          // harmonics by set-up, and what they are locked to
void TestDirection(const Sample& sample, Tests& tests);     // mean, harmonics, dwell, speed
void TestGroups(const Sample& sample, Tests& tests);        // variance components: set-up, pass, place
void TestTemperature(const Sample& sample, Tests& tests);   // behind a first-order lag, and its rate
void TestSpot(const Sample& sample, Tests& tests);          // Legendre polynomials and periods of its coordinates
void TestSpotMap(const Sample& sample, Tests& tests);       // cells of the detector
void TestPatterns(const Sample& sample, Tests& tests);      // which body moves
void TestChannelOrder(const Sample& sample, Tests& tests);  // what the channel before leaves behind

}  // namespace twinbench::diagnose::screen
