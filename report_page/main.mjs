// Brings the page to life; without it, its text and pictures stand by themselves.
import {makeContents, makeTheme, makeTools} from "page";
import {makeCharts} from "plots";
import {makeViewer} from "viewer";

makeTheme();
makeContents();
makeTools();

function told(place, error) {
  console.error(error);
  const note = document.createElement("p");
  note.className = "fine";
  note.textContent = `This cannot be shown here: ${error.message}.`;
  place.append(note);
}

const viewer = document.getElementById("viewer");
if (typeof DecompressionStream === "undefined") {
  for (const place of document.querySelectorAll("#viewer, .charts"))
    told(place, new Error("the browser is too old to unpack the data; one of 2023 or later will do"));
} else {
  if (window.d3) makeCharts().catch((error) => told(document.querySelector(".charts"), error));
  if (viewer) makeViewer(viewer).catch((error) => told(viewer, error));
}
