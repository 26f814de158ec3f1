// The theme keeps the first colours that it shows. Here the reader's system decides, until the button is pressed.
document.addEventListener("click", event => {
  if (event.target.closest("label[for^=__palette]")) localStorage.setItem("coloursChosen", "yes");
});
if (!localStorage.getItem("coloursChosen"))
  for (const key of Object.keys(localStorage))
    if (key.endsWith(".__palette")) localStorage.removeItem(key);
