// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/guidance.hpp"

#include <algorithm>

namespace tread::gap {

const std::vector<Word>& glossary() {
  static const std::vector<Word> words{
      {"execution", "2 s of driving that the model predicts from its measured beginning"},
      {"end error",
       "how far the predicted pose is from the measured one at the end of an execution"},
      {"held-out", "driving that was kept apart from the fit; only its errors count as proof"},
      {"block",
       "about 20 s of driving, long enough to know nothing of the next one; chance is counted in "
       "blocks, not in samples"},
      {"nats",
       "unit of evidence: the model makes held-out data e^n times as likely; a gain counts when it "
       "is well above its standard error"},
      {"score, p",
       "how clearly the residuals have an effect's signature, and the chance of so clear a one "
       "anywhere in the catalogue if nothing were there"},
      {"group",
       "confounded effects: the same to the INS; a tape or another sensor tells them apart"},
      {"runner-up",
       "an effect that explains the drive, too; one within its standard error is as good"},
      {"adequacy",
       "the test whether what the model leaves still depends on anything (speed, yaw rate, "
       "time..)"},
      {"floor",
       "the end error of dead reckoning with encoders and gyro: what a model can hope for"},
      {"negligible", "beyond chance, but less than 1 % of the end error: not added"},
      {"envelope", "the fastest motions that the model was made from; beyond them it guesses"}};
  return words;
}

const std::vector<Advice>& advices() {
  static const std::vector<Advice> all{
      {GapVerdict::kNoDiscrepancy,
       "nothing beyond chance; the report says from which size on each effect would have been seen",
       "Keep the model (after --calibrate: take model.yaml). To look deeper, drive longer or what "
       "this drive did not show."},
      {GapVerdict::kFound, "effects by name, with sizes and intervals; the model has them in",
       "Check each in two minutes, as the report says; run find with --test and a log of another "
       "day; then take model.yaml."},
      {GapVerdict::kAmbiguous,
       "it is one of several that this drive cannot tell apart; what tells is said",
       "The new model drives like the log whichever it is. To know which, measure or drive what "
       "the report says, and give find both logs."},
      {GapVerdict::kPartial, "effects were found, and the residuals still depend on something",
       "Use model.yaml if its error is small enough for you. Else look at the curve of what is "
       "unexplained, drive more of that, and give find both logs."},
      {GapVerdict::kNotInCatalogue,
       "there is a disagreement and no effect of the catalogue explains it; on what it depends is "
       "said",
       "Do not trust the model where the residuals depend on something. Look at the vehicle: loose "
       "tracks, load, tyres, other software; drive more of what is named."},
      {GapVerdict::kMeasurement,
       "the INS, not the vehicle; only the measurement part of the model changes",
       "Mend the INS: lever arm, mounting, time stamps. Or keep the measurement part of "
       "model.yaml."},
      {GapVerdict::kCannotTell,
       "too little driving, a log that is not sound, or a size that is no measurement; no model is "
       "written",
       "Mend the log, or drive what is missing; the reason says which."}};
  return all;
}

const Advice& adviceFor(GapVerdict verdict) {
  return *std::find_if(advices().begin(), advices().end(),
                       [verdict](const Advice& advice) { return advice.verdict == verdict; });
}

const std::vector<Word>& firstSteps() {
  static const std::vector<Word> steps{
      {"drive",
       "at least 200 s, better 10 minutes: three speeds forwards and backwards, turns on the spot, "
       "arcs both ways, sudden changes, 30 s of standing still"},
      {"write a CSV",
       "20 rows a second with the columns step (a number, the same as long as the log does not "
       "pause), t_s, cmd_left_rad_s, cmd_right_rad_s, wheel_left_rad_s, wheel_right_rad_s (of "
       "wheels or sprockets), x_m, y_m, yaw_rad, z_m, roll_rad, pitch_rad (the latest pose), "
       "pose_new (1 in rows with a new pose, else 0), imu_yaw_rate_rad_s (left is positive)"},
      {"describe it",
       "sessions.csv with one row: session (the CSV's name without .csv), robot, surface, "
       "wheel_radius_m, baseline_m (between the tracks), pose_lag_s (0), pose_rate_hz, "
       "imu_sign_applied (1), roll_pitch (absolute), n_rows (of the CSV)"},
      {"import",
       "tread-import --format steps --keep-lag --gyro all --sessions sessions.csv mine.csv -o "
       "mine.lcmlog"},
      {"or log LCM", "a log with the robot's INS and MOTOR messages is read as it is"},
      {"first model",
       "ideal.yaml, three lines: 'name: ideal', 'kind: track_speed', 'gauge: 1.08' (baseline_m); "
       "for an LCM log whose commands are powers from -1 to 1 'kind: power' and the speed at full "
       "power, 'full_speed: 2.0' (m/s)"},
      {"find",
       "tread-gap find --model ideal.yaml --train mine.lcmlog --out gap; with --calibrate lag, "
       "delay and gains become numbers of the new model instead of effects by name"},
      {"read", "gap/report.html; then tread-gap explain verdicts"}};
  return steps;
}

}  // namespace tread::gap
