// A page that `osculate view` serves: asks its server what is new, takes it in, and can end the run.
import {renew} from "data";
import {make} from "page";

const least = 2000, idle = 10000; // ms between two looks
const words = {running: "The run goes on", done: "The run has completed", gave_up: "The run gave up", interrupted: "The run was ended"};

/// @param present  shows what is in the page, with what the viewer had been set to
export function follow(tag, present, viewer) {
  const said = make("span", {role: "status"}), end = make("button", {type: "button", id: "end-run"}, "End the run");
  const bar = make("div", {class: "live"}, said, end);
  document.querySelector("header.top .kicker").after(bar);
  let stamp = tag.dataset.stamp, shown = viewer, asked = false;

  end.addEventListener("click", async () => {
    if (!confirm("End the run after its step? osculate resume goes on from there.")) return;
    const reply = await fetch("/end", {method: "POST", headers: {"Osculate-Token": tag.content}});
    asked = reply.ok;
    said.textContent = (await reply.text()).trim();
    end.disabled = asked;
  });

  async function takeIn() {
    const reply = await fetch("/", {cache: "no-store"});
    if (!reply.ok) throw new Error((await reply.text()).trim());
    const next = new DOMParser().parseFromString(await reply.text(), "text/html");
    const main = document.querySelector("main"), top = scrollY, kept = shown?.settings();
    const open = new Set([...document.querySelectorAll("main details[open]")].map((one) => one.textContent.slice(0, 40)));
    shown?.dispose();
    main.style.minHeight = `${main.offsetHeight}px`; // nothing jumps while plots are drawn anew
    for (const part of ["h1", ".lead", "dl.figures", ".kicker span:nth-of-type(2)"])
      document.querySelector(`header.top ${part}`)?.replaceWith(document.adoptNode(next.querySelector(`header.top ${part}`)));
    main.replaceChildren(...[...next.querySelectorAll("main > section")].map((one) => document.adoptNode(one)));
    for (const one of main.querySelectorAll("details")) one.open = open.has(one.textContent.slice(0, 40));
    renew(next);
    document.title = next.title;
    stamp = next.querySelector("meta[name=osculate-live]").dataset.stamp;
    // the server may have been started anew, with another token
    tag.content = next.querySelector("meta[name=osculate-live]").content;
    shown = await present(kept);
    main.style.minHeight = "";
    scrollTo({top, behavior: "instant"});
  }

  async function look() {
    let wait = idle;
    try {
      const state = await (await fetch("/state", {cache: "no-store"})).json();
      if (state.running) wait = least;
      if (state.stamp !== stamp && !shown?.playing) {
        const begin = performance.now();
        await takeIn();
        wait = Math.max(wait, 3 * (performance.now() - begin)); // at most a quarter of the time goes into it
      }
      end.hidden = !state.can_end;
      const killed = !state.running && state.status === "running";
      if (!asked || !state.running) said.textContent = killed ? "The run was killed: osculate resume goes on from its last checkpoint" : words[state.status] ?? state.status;
      if (!state.running) asked = false;
      bar.dataset.running = state.running;
    } catch (error) {
      said.textContent = error instanceof TypeError ? "osculate view has ended: the page stays as it is" : error.message;
      end.hidden = true;
    }
    setTimeout(look, wait);
  }
  look();
}
