# The Java side of the messages: the jar with which lcm-spy decodes our channels, and lcm-spy itself.
# Debian's lcm-spy wrapper passes -Xincgc, an option Java 9 dropped, and does not start; so java is
# started here.

JAVA     ?= java
JAVAC    ?= javac
JAR      ?= jar
LCM_JAR  ?= /usr/share/java/lcm.jar
CHART_JAR ?= /usr/share/java/jchart2d.jar
LCM_URL  ?= udpm://239.255.76.67:7667?ttl=0
jar_file := $(BUILD)/digsight_types.jar

jar: $(jar_file) ## Build the jar with which lcm-spy decodes our channels

$(jar_file): $(wildcard messages/*.lcm)
	$(call say,JAR,$@)
	$(Q)rm -rf $(BUILD)/java && mkdir -p $(BUILD)/java/src $(BUILD)/java/classes
	$(Q)$(LCM_GEN) -j --jpath $(BUILD)/java/src $^
	$(Q)$(JAVAC) -nowarn -encoding UTF-8 -cp $(LCM_JAR) -d $(BUILD)/java/classes \
	    $$(find $(BUILD)/java/src -name '*.java' 2>/dev/null)
	$(Q)$(JAR) cf $@ -C $(BUILD)/java/classes .

spy: ## Watch the daemon's channels live with lcm-spy (LCM_URL=… for another network)
	$(Q)scripts/setup.sh build spy
	$(Q)$(MAKE) --no-print-directory $(jar_file)
	$(Q)$(JAVA) -Djava.net.preferIPv4Stack=true -ea -cp '$(LCM_JAR):$(CHART_JAR):$(jar_file)' lcm.spy.Spy \
	    --lcm-url='$(LCM_URL)'
