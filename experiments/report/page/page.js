"use strict";
// Starts the parts. The page opens at the moment that the first contact was detected.

showVerdict();
showStory();
showAppendix();
scene.start();
player.start();
charts.start();
lanes.start();

// Paper is light. Of parameters and files it shows what is unfolded.
for (const [event, printing] of [["beforeprint", true], ["afterprint", false]]) {
  addEventListener(event, () => {
    document.documentElement.classList.toggle("printing", printing);
    charts.recolour();
  });
}

const opening = report.contacts[0];
clock.seekTime(opening ? opening.detected ?? opening.start : wholeRun[0]);
charts.zoomTo("contact");
