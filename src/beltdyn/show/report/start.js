// What is on the page comes to life.

const motions = read("motions"), colors = read("colors"), drawn = read("charts");
document.documentElement.classList.add("live");
for (const [name, data] of Object.entries(motions)) new (data.modes ? Swing : Motion)(document.getElementById(name), data, colors);
if (drawn.items) showCharts(drawn);
