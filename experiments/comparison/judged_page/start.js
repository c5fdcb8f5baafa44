"use strict";
// Starts the parts.

showJudgement();
charts.start();
lanes.start();
clock.seekTime(wholeRun[0]);
charts.zoomTo("whole");
