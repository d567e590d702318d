"use strict";
for (const slider of document.querySelectorAll(".slider")) {
  const input = slider.querySelector("input");
  const move = () => slider.style.setProperty("--at", input.value + "%");
  input.addEventListener("input", move);
  move();
}
for (const orbit of document.querySelectorAll(".orbit")) {
  const input = orbit.querySelector("input"), img = orbit.querySelector("img");
  if (!input) continue;
  const name = i => "view." + String(i).padStart(3, "0") + ".jpg";
  for (let i = 0; i <= +input.max; i++) new Image().src = name(i);
  input.addEventListener("input", () => { img.src = name(input.value); });
}
