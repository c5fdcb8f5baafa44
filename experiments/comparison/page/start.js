"use strict";
// Starts the parts.

showComparison();
charts.start();
lanes.start();
clock.seekTime(wholeRun[0]);
charts.zoomTo("whole");
