// Brings the page to life; without it, its text and pictures stand by themselves.
import {clock} from "clock";
import {makeContents, makeTheme, makeTools} from "page";
import {makePaths} from "paths";
import {makeCharts} from "plots";
import {makeViewer} from "viewer";

function told(place, error) {
  console.error(error);
  const note = document.createElement("p");
  note.className = "fine";
  note.textContent = `This cannot be shown here: ${error.message}.`;
  place.append(note);
}

/// @param settings  of a viewer before this one
/// @returns  the viewer, if there is one
async function present(settings) {
  clock.forget();
  makeContents();
  makeTools();
  const place = document.getElementById("viewer");
  if (typeof DecompressionStream === "undefined") {
    for (const one of document.querySelectorAll("#viewer, .charts"))
      told(one, new Error("the browser is too old to unpack the data; one of 2023 or later will do"));
    return undefined;
  }
  const charts = window.d3 ? makeCharts().catch((error) => told(document.querySelector(".charts"), error)) : undefined;
  const viewer = place ? await makeViewer(place, settings).catch((error) => told(place, error)) : undefined;
  await charts;
  const paths = document.querySelector("[data-charts=paths]");
  if (window.d3 && paths) await makePaths(paths, viewer !== undefined).catch((error) => told(paths, error));
  return viewer;
}

makeTheme();
const viewer = await present();
const live = document.querySelector("meta[name=osculate-live]");
if (live) (await import("live")).follow(live, present, viewer);
