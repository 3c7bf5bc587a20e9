# zsh_offers.zsh DIRECTORY LINE: what zsh with the completions of the directory shows when the line is typed and its end
# is to be completed. It runs on a terminal of its own; its editor tells when it begins, and at ^X where it stands.
zmodload zsh/zpty
cat >$1/.zshrc <<'SETTINGS'
PS1= fpath=($ZDOTDIR $fpath) LISTMAX=1000
autoload -U compinit; compinit -u -D
stty cols 200
begun() { print THE''START }; zle -N zle-line-init begun
over() { print THE''END }; zle -N over
bindkey '^I' list-choices '^X' over
SETTINGS
zpty shell "ZDOTDIR=$1 zsh -d -i"
zpty -r shell output '*THESTART*'
zpty -w -n shell "$2"$'\t\x18'
zpty -r shell output '*THEEND*'
zpty -d shell
# Without what moves the cursor about, and without the line itself.
print -r -- $output | sed $'s/\e\\[[0-9;?]*[A-Za-z]/ /g; s/\r/\\n/g' | grep -vF -- "$2" | grep -v THEEND
