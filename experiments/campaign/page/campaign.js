"use strict";
// Starts the parts.

function showCampaign() {
  document.title = `${campaign.title} · flinch`;
  byId("title").textContent = campaign.title;
  byId("description").textContent = campaign.description;
  const mark = byId("mark");
  mark.textContent = campaign.faults === 0 ? `✓ ${campaign.runs} runs, no fault` : `✗ ${campaign.faults} of ${campaign.runs} runs stopped by a fault`;
  mark.classList.add(campaign.faults === 0 ? "good" : "bad");
  const places = campaign.runs / campaign.draws;
  const each = places === 1 ? "" : ` at each of ${places} places of the grid`;
  byId("summary").textContent = `${campaign.draws} ${campaign.draws === 1 ? "draw" : "draws"}${each}, ${duration(campaign.simulated_h)} simulated. ` +
    `A contact that is not detected within ${inMs(campaign.missed_after, 0)} ms counts as missed.`;
}

function showProvenance() {
  listProvenance(campaign.provenance);
  byId("texts").replaceChildren(...campaign.texts.map(({ title, text }) =>
    element("details", {}, element("summary", {}, title), element("pre", {}, text))));
}

showCampaign();
showTimes();
showTrade();
showReactions();
showGroups();
showRuns();
showProvenance();
